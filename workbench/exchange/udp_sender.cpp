#include "workbench/exchange/udp_sender.h"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>
#include <cerrno>
#include <charconv>
#include <cstring>

#include "config/schema/error.h"

namespace workbench::exchange {
namespace {

using config::schema::RunError;
using config::schema::UsageError;

bool is_port(const std::string& text) {
  int port = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, port);
  return result.ec == std::errc() && result.ptr == end && port >= 1 && port <= 65535;
}

}  // namespace

UdpAddress udp_address(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  UdpAddress address;
  if (colon != std::string::npos) {
    address = {text.substr(0, colon), text.substr(colon + 1)};
    if (address.host.starts_with('[') && address.host.ends_with(']')) {
      address.host = address.host.substr(1, address.host.size() - 2);
    } else if (address.host.find(':') != std::string::npos) {
      address.host.clear();  // IPv6 without brackets: where does the port begin?
    }
  }
  if (address.host.empty() || !is_port(address.port)) {
    throw UsageError("--udp " + text + ": is no address; allowed: HOST:PORT, [IPV6]:PORT");
  }
  return address;
}

UdpSender::UdpSender(const UdpAddress& address) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found);
  const std::string place = "--udp " + address.host + ": ";
  if (error != 0) throw RunError(place + gai_strerror(error));
  int why = 0;
  for (const addrinfo* a = found; a != nullptr && socket_ < 0; a = a->ai_next) {
    socket_ = socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, a->ai_protocol);
    // Connected, the socket hears when nobody listens.
    if (socket_ >= 0 && connect(socket_, a->ai_addr, a->ai_addrlen) == 0) continue;
    why = errno;
    if (socket_ >= 0) close(socket_);
    socket_ = -1;
  }
  freeaddrinfo(found);
  if (socket_ < 0) throw RunError(place + std::strerror(why));
}

UdpSender::~UdpSender() { close(socket_); }

int UdpSender::send(const std::string& datagram) noexcept {
  const ssize_t n = ::send(socket_, datagram.data(), datagram.size(), MSG_NOSIGNAL);
  if (n == static_cast<ssize_t>(datagram.size())) {
    ++sent_;
    return 0;
  }
  const int error = n < 0 ? errno : EMSGSIZE;
  ++dropped_;
  return error;
}

namespace {

constexpr std::size_t kLongestText = 100;

/// One half of the members of the first object below `tree` that has several; false when there is
/// none.
bool keep_half(Tree& tree, bool first) {
  if (!tree.is_object()) return false;
  if (tree.size() > 1) {
    Tree half = Tree::object();
    std::size_t i = 0;
    for (auto& [key, value] : tree.items()) {
      if ((i++ < tree.size() / 2) == first) half[key] = std::move(value);
    }
    tree = std::move(half);
    return true;
  }
  return !tree.empty() && keep_half(tree.begin().value(), first);
}

void cut_texts(Tree& tree) {
  for (auto& value : tree) {
    if (value.is_structured()) cut_texts(value);
    if (!value.is_string()) continue;
    auto& text = value.get_ref<std::string&>();
    if (text.size() <= kLongestText) continue;
    text.resize(kLongestText);
    while (!text.empty() && (text.back() & 0x80) != 0) text.pop_back();  // no half letters
    text += "...";
  }
}

void split(Message message, std::size_t most_bytes, std::vector<std::string>& out) {
  std::string text = text_of(with_timestamp(message));
  if (text.size() > most_bytes) {
    Message rest = message;
    if (keep_half(message.values, true) && keep_half(rest.values, false)) {
      split(std::move(message), most_bytes, out);
      split(std::move(rest), most_bytes, out);
      return;
    }
    cut_texts(message.values);
    text = text_of(with_timestamp(message));
    if (text.size() > most_bytes) return;  // names longer than a datagram: not from our daemon
  }
  out.push_back(std::move(text));
}

}  // namespace

std::vector<std::string> datagrams_of(const Message& message, std::size_t most_bytes) {
  std::vector<std::string> out;
  split(message, most_bytes, out);
  return out;
}

}  // namespace workbench::exchange
