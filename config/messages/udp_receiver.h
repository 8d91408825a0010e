// Receives LCM messages by UDP multicast without liblcm (udp_packets.h says why). A thread empties
// the socket into a bounded queue, so that a slow reader loses the newest messages and nothing
// else.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "config/messages/udp_packets.h"

namespace config::messages {

class UdpReceiver {
 public:
  static constexpr std::size_t kMostQueued = 6000;  ///< messages: 10 s of samples and more
  static constexpr std::size_t kMostQueuedBytes = 64 << 20;

  /// `url`: "udpm://GROUP:PORT?...", group and port as LCM's where they are missing. `wants`
  /// chooses channels and is called in the thread. Throws schema::ConfigError.
  UdpReceiver(const std::string& url, std::function<bool(const std::string&)> wants);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  /// The next message, waiting for it up to the timeout.
  std::optional<ReceivedMessage> next(std::chrono::milliseconds timeout);

 private:
  void receive();

  std::function<bool(const std::string&)> wants_;
  int socket_ = -1;
  int end_[2] = {-1, -1};  ///< closed to end the thread
  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<ReceivedMessage> queue_;  // under mutex_
  std::size_t queued_bytes_ = 0;       // under mutex_
  std::thread thread_;
};

/// True for the URLs that UdpReceiver receives on.
[[nodiscard]] bool is_udp(const std::string& url);

}  // namespace config::messages
