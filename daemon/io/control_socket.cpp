#include "daemon/io/control_socket.h"

#include <fcntl.h>
#include <grp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <tuple>

#include "config/schema/error.h"
#include "daemon/control/protocol.h"
#include "hal/monotonic.h"

namespace monitor::io {
namespace {

using config::schema::bad_config;
using config::schema::RunError;

constexpr gid_t kNoGroup = static_cast<gid_t>(-1);
/// Connections of those who may command, and of those who may only query.
constexpr std::size_t kMaxActing = 64;
constexpr std::size_t kMaxLooking = 16;
/// Few, since that of a command may stand behind them: who finds no room waits in connect().
constexpr int kBacklog = 16;
constexpr int kAcceptedAtOnce = 64;
/// Requests of one user who may only query: a live view asks a few times a second.
constexpr double kLooksPerSecond = 50.0;
constexpr double kMostLooks = 20.0;
constexpr std::size_t kMostAllowances = 1000;
constexpr std::size_t kMaxPath = sizeof(sockaddr_un::sun_path) - 1;
constexpr std::size_t kMaxGroups = 65536;

RunError cannot(const std::string& what, int error) {
  return RunError(what + ": " + std::strerror(error));
}

/// Octal permissions, or throws.
mode_t mode_of(const std::string& text, const std::string& file) {
  const bool octal =
      !text.empty() && text.size() <= 4 && text.find_first_not_of("01234567") == std::string::npos;
  const unsigned long mode = octal ? std::stoul(text, nullptr, 8) : 01000;
  if (mode > 0777) {
    throw bad_config(file + ": [control] mode", "is \"" + text + "\"",
                     "octal, \"0600\" to \"0777\"");
  }
  return static_cast<mode_t>(mode);
}

gid_t group_of(const std::string& name, const std::string& file, const char* key = "group") {
  if (name.empty()) return kNoGroup;
  const group* entry = getgrnam(name.c_str());
  if (entry == nullptr) {
    throw bad_config(file + ": [control] " + key,
                     "is \"" + name + "\", which is not a group on this machine",
                     "an existing group, or \"\"");
  }
  return entry->gr_gid;
}

sockaddr_un address_of(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.string().copy(address.sun_path, kMaxPath);
  return address;
}

bool in_group(int file, const ucred& peer, gid_t group) {
  if (group == kNoGroup) return false;
  if (peer.gid == group) return true;
  std::vector<gid_t> groups(64);
  auto size = static_cast<socklen_t>(groups.size() * sizeof(gid_t));
  if (getsockopt(file, SOL_SOCKET, SO_PEERGROUPS, groups.data(), &size) != 0) {
    if (errno != ERANGE || size > kMaxGroups * sizeof(gid_t)) return false;
    groups.resize(size / sizeof(gid_t));
    if (getsockopt(file, SOL_SOCKET, SO_PEERGROUPS, groups.data(), &size) != 0) return false;
  }
  groups.resize(size / sizeof(gid_t));
  return std::find(groups.begin(), groups.end(), group) != groups.end();
}

/// No rights when the kernel does not identify the peer.
ucred peer_of(int file) {
  ucred peer{0, static_cast<uid_t>(-1), static_cast<gid_t>(-1)};
  socklen_t size = sizeof peer;
  if (getsockopt(file, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) {
    peer.uid = static_cast<uid_t>(-1);
  }
  return peer;
}

bool may_act(int file, const ucred& peer, gid_t group) {
  if (peer.uid == static_cast<uid_t>(-1)) return false;
  return peer.uid == 0 || peer.uid == geteuid() || in_group(file, peer, group);
}

/// True when a process answers on that socket.
bool is_served(const sockaddr_un& address) {
  const int probe = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (probe < 0) return false;
  const bool connected =
      connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ||
      errno == EAGAIN;
  close(probe);
  return connected;
}

}  // namespace

void ControlConfig::visit(config::schema::Visitor& v) {
  v.path({"socket", "path of the control socket; empty: none"}, socket);
  v.text({"mode", "permissions of the socket, octal"}, mode);
  v.text({"group", "group of the socket; its members may connect and query as mode allows"}, group);
  v.text({"act_group", "group whose members may send commands; empty: members of group"},
         act_group);
}

void check_control(const ControlConfig& config, const std::string& file) {
  mode_of(config.mode, file);
  group_of(config.group, file);
  group_of(config.act_group, file, "act_group");
  if (config.socket.size() > kMaxPath) {
    throw bad_config(file + ": [control] socket",
                     "is " + std::to_string(config.socket.size()) + " characters long",
                     "at most " + std::to_string(kMaxPath));
  }
}

ControlSocket::ControlSocket(const ControlConfig& config, const std::string& file)
    : path_(config.socket),
      group_(group_of(config.group, file)),
      act_group_(config.act_group.empty() ? group_
                                          : group_of(config.act_group, file, "act_group")) {
  check_control(config, file);
  const std::string place = "control socket " + path_.string();
  std::error_code ignored;
  std::filesystem::create_directories(path_.parent_path(), ignored);
  lock_ = open((path_.string() + ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (lock_ < 0) throw cannot(place + " cannot be made", errno);
  const sockaddr_un address = address_of(path_);
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0 || is_served(address)) {
    close(lock_);
    throw RunError(place + ": another daemon serves it; one rig, one daemon");
  }
  const auto fail = [&](const std::string& what, int error) {
    if (listener_ >= 0) close(listener_);
    close(lock_);
    return cannot(what, error);
  };
  struct stat status {};
  if (lstat(path_.c_str(), &status) == 0) {
    if (!S_ISSOCK(status.st_mode)) throw fail(place + " cannot be made", EEXIST);
    unlink(path_.c_str());
  }
  listener_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  // Only the owner may connect before the permissions are set.
  if (listener_ < 0 || fchmod(listener_, 0600) != 0 ||
      bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw fail(place + " cannot be made", errno);
  }
  if ((group_ != kNoGroup && chown(path_.c_str(), static_cast<uid_t>(-1), group_) != 0) ||
      chmod(path_.c_str(), mode_of(config.mode, file)) != 0 || listen(listener_, kBacklog) != 0) {
    const int error = errno;
    unlink(path_.c_str());
    throw fail(place + " cannot be given to group \"" + config.group + "\"", error);
  }
}

ControlSocket::~ControlSocket() {
  for (const Client& client : clients_) close(client.file);
  unlink(path_.c_str());
  close(listener_);
  close(lock_);
}

void ControlSocket::wait(int timeout_ms, int other) {
  std::vector<pollfd> files{{other, POLLIN, 0}, {listener_, POLLIN, 0}};
  for (const Client& client : clients_) {
    if (client.head && !client.asking && !client.may_act) {
      const int due_ms = static_cast<int>(std::ceil(1e3 * wait_s(client.uid)));
      timeout_ms = std::min(timeout_ms, due_ms);
    }
    const bool reads = !client.asking && client.in.size() <= control::kMaxLine;
    files.push_back({client.file,
                     static_cast<short>((reads ? POLLIN : 0) | (client.out.empty() ? 0 : POLLOUT)),
                     0});
  }
  if (poll(files.data(), files.size(), timeout_ms) <= 0) return;
  for (std::size_t i = 0; i < clients_.size(); ++i) {
    const short events = files[i + 2].revents;
    if ((events & POLLOUT) != 0) write(clients_[i]);
    if ((events & (POLLIN | POLLHUP | POLLERR)) != 0) read(clients_[i]);
  }
  drop_gone();
  if (files[1].revents != 0) accept_clients();
}

void ControlSocket::accept_clients() {
  for (int i = 0; i < kAcceptedAtOnce; ++i) {
    const int file = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (file < 0) return;
    const ucred peer = peer_of(file);
    const bool acts = may_act(file, peer, act_group_);
    if (!make_room(acts)) {
      close(file);
      continue;
    }
    const std::int64_t owner = acts ? peer.pid : static_cast<std::int64_t>(peer.uid);
    clients_.push_back(
        {next_id_++, file, acts, peer.uid, owner, false, ++turn_, 0, 0, {}, {}, {}, false});
  }
}

bool ControlSocket::make_room(bool may_act) {
  std::map<std::int64_t, std::size_t> of_owner;
  std::size_t count = 0;
  for (const Client& client : clients_) {
    if (client.may_act != may_act) continue;
    ++count;
    ++of_owner[client.owner];
  }
  if (count < (may_act ? kMaxActing : kMaxLooking)) return true;
  // The process or user with the most connections loses the one that has had the most answers,
  // and among equals the longest silent.
  Client* silent = nullptr;
  const auto order = [&](const Client& client) {
    return std::tuple(-static_cast<std::ptrdiff_t>(of_owner[client.owner]),
                      -static_cast<std::int64_t>(client.requests), client.heard);
  };
  for (Client& client : clients_) {
    if (client.may_act != may_act || client.asking) continue;
    if (silent == nullptr || order(client) < order(*silent)) silent = &client;
  }
  if (silent == nullptr) return false;
  silent->gone = true;
  drop_gone();
  return true;
}

ControlSocket::Urgency ControlSocket::urgency_of(const Client& client) noexcept {
  using Kind = ControlRequest::Kind;
  if (!client.may_act) return Urgency::look;
  const ControlRequest& request = *client.head;
  if (request.kind == Kind::event) {
    return request.event == control::Event::stop || request.event == control::Event::disarm
               ? Urgency::stop
               : Urgency::loop;
  }
  return request.kind == Kind::hold || request.kind == Kind::sine ? Urgency::loop : Urgency::act;
}

double ControlSocket::wait_s(unsigned uid) {
  const std::int64_t now_ns = hal::monotonic_ns();
  if (allowances_.size() > kMostAllowances) allowances_.clear();
  Allowance& allowance = allowances_.try_emplace(uid, Allowance{kMostLooks, now_ns}).first->second;
  const double passed_s = static_cast<double>(now_ns - allowance.since_ns) * 1e-9;
  allowance = {std::min(kMostLooks, allowance.requests + passed_s * kLooksPerSecond), now_ns};
  return std::max(0.0, (1.0 - allowance.requests) / kLooksPerSecond);
}

void ControlSocket::read(Client& client) {
  char bytes[1024];
  const ssize_t n = recv(client.file, bytes, sizeof bytes, 0);
  if (n > 0) {
    client.in.append(bytes, static_cast<std::size_t>(n));
    client.heard = ++turn_;
    find_head(client);
    const bool endless =
        client.in.size() > control::kMaxLine && client.in.find('\n') == std::string::npos;
    client.gone = client.gone || endless;
  } else if (n == 0 || (errno != EAGAIN && errno != EINTR)) {
    client.gone = true;
  }
}

void ControlSocket::write(Client& client) {
  const ssize_t n = send(client.file, client.out.data(), client.out.size(), MSG_NOSIGNAL);
  if (n > 0) {
    client.out.erase(0, static_cast<std::size_t>(n));
  } else if (errno != EAGAIN && errno != EINTR) {
    client.gone = true;
  }
}

void ControlSocket::drop_gone() {
  for (const Client& client : clients_) {
    if (client.gone) close(client.file);
  }
  std::erase_if(clients_, [](const Client& client) { return client.gone; });
}

void ControlSocket::find_head(Client& client) {
  const std::size_t end = client.in.find('\n');
  if (!client.head && end != std::string::npos) {
    client.head = parse_request(client.in.substr(0, end));
  }
}

bool ControlSocket::next(Request& request, const Accepts& accepts) {
  Client* first = nullptr;
  const auto order = [](const Client& client) {
    return std::tuple(urgency_of(client), client.served);
  };
  for (Client& client : clients_) {
    if (client.asking || !client.head || (accepts && !accepts(*client.head))) continue;
    if (!client.may_act && wait_s(client.uid) > 0.0) continue;
    if (first == nullptr || order(client) < order(*first)) first = &client;
  }
  if (first == nullptr) return false;
  if (!first->may_act) allowances_.at(first->uid).requests -= 1.0;
  const std::size_t end = first->in.find('\n');
  request = {first->id, first->in.substr(0, end), first->may_act, first->uid, *first->head};
  first->in.erase(0, end + 1);
  first->head.reset();
  find_head(*first);
  first->asking = true;
  first->served = ++turn_;
  ++first->requests;
  return true;
}

void ControlSocket::answer(std::uint64_t id, const std::string& line) {
  for (Client& client : clients_) {
    if (client.id != id) continue;
    client.asking = false;
    client.out += line + '\n';
    if (client.out.size() > 64 * control::kMaxLine) client.gone = true;
    if (!client.gone) write(client);
  }
  drop_gone();
}

}  // namespace monitor::io
