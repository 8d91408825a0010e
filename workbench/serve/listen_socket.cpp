#include "workbench/serve/listen_socket.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "config/schema/error.h"

namespace workbench::serve {
namespace {

using config::schema::RunError;

constexpr int kWaiting = 128;

[[noreturn]] void fail(int file, const std::string& what) {
  const std::string why = std::strerror(errno);
  if (file >= 0) close(file);
  throw RunError(what + ": " + why);
}

int make(int family, const std::string& what) {
  const int file = socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (file < 0) fail(file, what);
  return file;
}

/// True where a process answers.
bool served(const sockaddr_un& address) {
  const int file = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (file < 0) return false;
  const bool answers =
      connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(file);
  return answers;
}

}  // namespace

std::optional<ListenSocket> passed_socket() {
  const char* const to = std::getenv("LISTEN_PID");
  if (to == nullptr || to != std::to_string(getpid())) return {};
  const char* const count = std::getenv("LISTEN_FDS");
  const bool one = count != nullptr && std::string_view(count) == "1";
  unsetenv("LISTEN_PID");
  unsetenv("LISTEN_FDS");
  constexpr int kPassed = 3;  // SD_LISTEN_FDS_START
  const std::string what = "socket of systemd";
  if (!one) throw RunError(what + ": is not one; allowed: one ListenStream");
  int listens = 0;
  socklen_t size = sizeof listens;
  if (getsockopt(kPassed, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) != 0) fail(-1, what);
  sockaddr_storage address{};
  size = sizeof address;
  if (getsockname(kPassed, reinterpret_cast<sockaddr*>(&address), &size) != 0) fail(-1, what);
  fcntl(kPassed, F_SETFD, FD_CLOEXEC);
  const auto& inet = reinterpret_cast<const sockaddr_in&>(address);
  const bool here =
      address.ss_family == AF_UNIX ||
      (address.ss_family == AF_INET && ntohl(inet.sin_addr.s_addr) == INADDR_LOOPBACK);
  if (listens == 0 || !here) {
    throw RunError(what +
                   ": does not listen on this machine alone; allowed: 127.0.0.1:PORT or the "
                   "path of a Unix socket");
  }
  if (address.ss_family == AF_INET) return ListenSocket{kPassed, ntohs(inet.sin_port), "", true};
  return ListenSocket{kPassed, 0, reinterpret_cast<const sockaddr_un&>(address).sun_path, true};
}

ListenSocket listen_on_port(unsigned short port) {
  const std::string what = "127.0.0.1:" + std::to_string(port);
  const int file = make(AF_INET, what);
  const int yes = 1;
  setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const general = reinterpret_cast<sockaddr*>(&address);
  if (bind(file, general, size) != 0 || listen(file, kWaiting) != 0 ||
      getsockname(file, general, &size) != 0) {
    fail(file, what);
  }
  return {file, ntohs(address.sin_port), ""};
}

ListenSocket listen_on_path(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    throw config::schema::UsageError("--socket " + path + ": is not a path of at most " +
                                     std::to_string(sizeof address.sun_path - 1) + " bytes");
  }
  path.copy(address.sun_path, path.size());
  struct stat entry {};
  if (lstat(path.c_str(), &entry) == 0) {
    if (!S_ISSOCK(entry.st_mode)) throw RunError(path + ": exists and is no socket");
    if (served(address)) throw RunError(path + ": another process serves it");
    unlink(path.c_str());
  }
  const int file = make(AF_UNIX, path);
  const mode_t before = umask(0177);
  const bool bound = bind(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  umask(before);
  if (!bound || listen(file, kWaiting) != 0) fail(file, path);
  return {file, 0, path};
}

}  // namespace workbench::serve
