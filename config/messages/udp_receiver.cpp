#include "config/messages/udp_receiver.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <vector>

#include "config/schema/error.h"

namespace config::messages {
namespace {

constexpr const char* kScheme = "udpm://";
constexpr const char* kDefaultGroup = "239.255.76.67";
constexpr int kDefaultPort = 7667;
constexpr int kSocketBytes = 4 << 20;
constexpr std::size_t kMostDatagram = 65536;

schema::ConfigError unusable(const std::string& url, const std::string& why) {
  return schema::bad_config("LCM URL \"" + url + "\"", "LCM cannot start (" + why + ")",
                            "udpm://GROUP:PORT?ttl=N with a multicast route to GROUP, "
                            "file:///LOG?mode=r of a readable log, tcpq://HOST:PORT of a server");
}

sockaddr_in group_of(const std::string& url) {
  std::string place = url.substr(std::strlen(kScheme));
  place = place.substr(0, place.find('?'));
  std::string host = place.substr(0, place.find(':'));
  int port = kDefaultPort;
  if (const std::size_t colon = place.find(':'); colon != std::string::npos) {
    const char* end = place.data() + place.size();
    const auto result = std::from_chars(place.data() + colon + 1, end, port);
    if (result.ec != std::errc() || result.ptr != end || port < 1 || port > 65535) {
      throw unusable(url, "\"" + place.substr(colon + 1) + "\" is no port");
    }
  }
  if (host.empty()) host = kDefaultGroup;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1 ||
      !IN_MULTICAST(ntohl(address.sin_addr.s_addr))) {
    throw unusable(url, "\"" + host + "\" is no multicast group");
  }
  return address;
}

}  // namespace

bool is_udp(const std::string& url) { return url.starts_with(kScheme); }

UdpReceiver::UdpReceiver(const std::string& url, std::function<bool(const std::string&)> wants)
    : wants_(std::move(wants)) {
  const sockaddr_in address = group_of(url);
  socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int yes = 1;
  const ip_mreq group{address.sin_addr, {htonl(INADDR_ANY)}};
  if (socket_ < 0 || setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) != 0 ||
      bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      setsockopt(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) != 0 ||
      pipe2(end_, O_CLOEXEC) != 0) {
    const int error = errno;
    if (socket_ >= 0) close(socket_);
    throw unusable(url, std::strerror(error));
  }
  if (setsockopt(socket_, SOL_SOCKET, SO_RCVBUFFORCE, &kSocketBytes, sizeof kSocketBytes) != 0) {
    (void)setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &kSocketBytes, sizeof kSocketBytes);
  }
  thread_ = std::thread([this] { receive(); });
}

UdpReceiver::~UdpReceiver() {
  close(end_[1]);
  thread_.join();
  close(end_[0]);
  close(socket_);
}

void UdpReceiver::receive() {
  PacketReassembler packets;
  std::vector<char> bytes(kMostDatagram);
  for (;;) {
    pollfd files[] = {{end_[0], POLLIN, 0}, {socket_, POLLIN, 0}};
    if (poll(files, 2, -1) < 0 && errno != EINTR) return;
    if (files[0].revents != 0) return;
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t n =
        recvfrom(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
    if (n < 0) continue;
    const std::uint64_t sender = std::uint64_t{from.sin_addr.s_addr} << 16U | from.sin_port;
    auto message = packets.add(sender, {bytes.data(), static_cast<std::size_t>(n)});
    if (!message || !wants_(message->channel)) continue;
    const std::lock_guard lock(mutex_);
    if (queue_.size() >= kMostQueued ||
        queued_bytes_ + message->payload.size() > kMostQueuedBytes) {
      continue;  // the numbers of the messages show the gap
    }
    queued_bytes_ += message->payload.size();
    queue_.push_back(std::move(*message));
    came_.notify_one();
  }
}

std::optional<ReceivedMessage> UdpReceiver::next(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  if (!came_.wait_for(lock, timeout, [this] { return !queue_.empty(); })) return {};
  ReceivedMessage message = std::move(queue_.front());
  queue_.pop_front();
  queued_bytes_ -= message.payload.size();
  return message;
}

}  // namespace config::messages
