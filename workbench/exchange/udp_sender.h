// Sends datagrams to one place, never waiting, and counts those that could not be sent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "workbench/exchange/message.h"

namespace workbench::exchange {

struct UdpAddress {
  std::string host;
  std::string port;
};

/// "HOST:PORT", "[ADDRESS]:PORT" for IPv6. Throws config::schema::UsageError for anything
/// else, a port out of 1 to 65535 among it.
[[nodiscard]] UdpAddress udp_address(const std::string& text);

class UdpSender {
 public:
  /// Throws config::schema::RunError for a host that is not known.
  explicit UdpSender(const UdpAddress& address);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// errno of what went wrong, 0 when it is on its way.
  int send(const std::string& datagram) noexcept;
  [[nodiscard]] std::uint64_t sent() const noexcept { return sent_; }
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  int socket_ = -1;
  std::uint64_t sent_ = 0;
  std::uint64_t dropped_ = 0;
};

/// JSON trees cut into pieces that fit into one UDP datagram each.
/// No fragments on Ethernet.
inline constexpr std::size_t kMostDatagramBytes = 1400;

/// The message as one or more objects, each with the time stamp, none longer than `most_bytes`
/// (200 at least). Texts that are too long for a datagram of their own are cut.
[[nodiscard]] std::vector<std::string> datagrams_of(const Message& message,
                                                    std::size_t most_bytes = kMostDatagramBytes);

}  // namespace workbench::exchange
