#include "hal/device_lock.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>

#include "config/schema/error.h"

namespace hal {
namespace {

using config::schema::RunError;

struct Address {
  sockaddr_un at{};
  socklen_t size = 0;
};

/// In the abstract namespace of Unix sockets: the kernel's, no file is left behind.
Address address_of(const std::string& name) {
  Address address;
  address.at.sun_family = AF_UNIX;
  const std::size_t n =
      ("spoolwatch/" + name).copy(address.at.sun_path + 1, sizeof address.at.sun_path - 1);
  address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + n);
  return address;
}

/// "process 1234 (spoolwatchd)".
std::string holder(const Address& address) {
  const int probe = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  ucred peer{};
  socklen_t size = sizeof peer;
  const bool known =
      probe >= 0 &&
      connect(probe, reinterpret_cast<const sockaddr*>(&address.at), address.size) == 0 &&
      getsockopt(probe, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.pid > 0;
  if (probe >= 0) close(probe);
  if (!known) return "another process";
  const std::string process = std::to_string(peer.pid);
  std::string name;
  std::getline(std::ifstream("/proc/" + process + "/comm"), name);
  return "process " + process + (name.empty() ? "" : " (" + name + ")");
}

}  // namespace

DeviceLock::DeviceLock(const std::string& name, const std::string& where)
    : file_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  const Address address = address_of(name);
  if (file_ >= 0 &&
      bind(file_, reinterpret_cast<const sockaddr*>(&address.at), address.size) == 0 &&
      listen(file_, 1) == 0) {
    return;
  }
  const int error = errno;
  if (file_ >= 0) close(file_);
  throw RunError(where + ": " +
                 (error == EADDRINUSE ? holder(address) + " drives it; one device, one daemon"
                                      : std::string(std::strerror(error))));
}

DeviceLock::~DeviceLock() { close(file_); }

}  // namespace hal
