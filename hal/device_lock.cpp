#include "hal/device_lock.h"

#include <arpa/inet.h>
#include <grp.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <pwd.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <vector>

#include "config/schema/error.h"

namespace hal {
namespace {

using config::schema::RunError;

constexpr const char* kClaims = "/proc/self/net/unix";
constexpr uid_t kFirstPerson = 1000;
/// Those who look at a claim stay in its queue.
constexpr int kBacklog = 4096;

struct Address {
  sockaddr_un at{};
  socklen_t size = 0;
};

/// In the abstract namespace of Unix sockets: the kernel's, no file is left behind.
Address address_of(const std::string& name) {
  Address address;
  address.at.sun_family = AF_UNIX;
  const std::size_t n = name.copy(address.at.sun_path + 1, sizeof address.at.sun_path - 1);
  address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + n);
  return address;
}

std::string own_claim(const std::string& device) {
  std::uint64_t random = 0;
  if (getrandom(&random, sizeof random, 0) != sizeof random)
    random = static_cast<unsigned>(getpid());
  return device + "/" + std::to_string(random);
}

/// Who made the claim; none when it cannot be found out.
std::optional<ucred> holder_of(const std::string& claim) {
  const Address address = address_of(claim);
  const int probe = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  ucred peer{};
  socklen_t size = sizeof peer;
  const bool known =
      probe >= 0 &&
      connect(probe, reinterpret_cast<const sockaddr*>(&address.at), address.size) == 0 &&
      getsockopt(probe, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.pid > 0;
  if (probe >= 0) close(probe);
  return known ? std::optional(peer) : std::nullopt;
}

bool counts(const ucred& holder) {
  if (holder.uid < kFirstPerson || holder.uid == geteuid() || holder.gid == getegid()) return true;
  std::array<char, 4096> memory{};
  passwd entry{};
  passwd* user = nullptr;
  if (getpwuid_r(holder.uid, &entry, memory.data(), memory.size(), &user) != 0 || user == nullptr)
    return false;
  std::array<gid_t, 256> groups{};
  int count = groups.size();
  if (getgrouplist(user->pw_name, user->pw_gid, groups.data(), &count) < 0) return false;
  return std::find(groups.begin(), groups.begin() + count, getegid()) != groups.begin() + count;
}

/// "process 1234 (spoolwatchd)".
std::string words_of(const ucred& holder) {
  const std::string process = std::to_string(holder.pid);
  std::string name;
  std::getline(std::ifstream("/proc/" + process + "/comm"), name);
  return "process " + process + (name.empty() ? "" : " (" + name + ")");
}

/// Claims on the device, all but the own one.
std::vector<std::string> other_claims(const std::string& device, const std::string& own) {
  std::vector<std::string> claims;
  std::ifstream in(kClaims);
  for (std::string line; std::getline(in, line);) {
    const std::size_t at = line.find(" @" + device);
    if (at == std::string::npos) continue;
    const std::string claim = line.substr(at + 2);
    const bool of_device = claim.size() == device.size() || claim[device.size()] == '/';
    if (of_device && claim != own) claims.push_back(claim);
  }
  return claims;
}

}  // namespace

DeviceLock::DeviceLock(const std::string& name, const std::string& where)
    : file_(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  const std::string device = "spoolwatch/" + name;
  const std::string own = own_claim(device);
  const Address address = address_of(own);
  if (file_ < 0 || bind(file_, reinterpret_cast<const sockaddr*>(&address.at), address.size) != 0 ||
      listen(file_, kBacklog) != 0) {
    const int error = errno;
    if (file_ >= 0) close(file_);
    throw RunError(where + ": " + std::strerror(error));
  }
  for (const std::string& claim : other_claims(device, own)) {
    const std::optional<ucred> holder = holder_of(claim);
    if (!holder || !counts(*holder)) continue;
    close(file_);
    throw RunError(where + ": " + words_of(*holder) + " drives it; one device, one daemon");
  }
}

DeviceLock::~DeviceLock() { close(file_); }

std::string device_host(const std::string& host) {
  constexpr const char* kHere = "127.0.0.1";
  in_addr wanted{};
  if (inet_pton(AF_INET, host.c_str(), &wanted) != 1) return host;
  if (wanted.s_addr == htonl(INADDR_ANY)) return kHere;
  if ((ntohl(wanted.s_addr) >> 24U) == IN_LOOPBACKNET) return host;
  ifaddrs* interfaces = nullptr;
  if (getifaddrs(&interfaces) != 0) return host;
  bool own = false;
  for (const ifaddrs* i = interfaces; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != AF_INET) continue;
    sockaddr_in address{};
    std::memcpy(&address, i->ifa_addr, sizeof address);
    own = own || address.sin_addr.s_addr == wanted.s_addr;
  }
  freeifaddrs(interfaces);
  return own ? kHere : host;
}

}  // namespace hal
