// Messages of a running daemon (or a log of one) over LCM, one by one, together with what only the
// receiver can notice: messages lost on the way, a restarted daemon, a silent one.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "config/messages/handler.h"
#include "config/messages/udp_receiver.h"

namespace lcm {
class LCM;
struct ReceiveBuffer;
}  // namespace lcm
namespace workbench::live {

/// Without a health message for so long the daemon counts as silent (it sends one a second).
inline constexpr std::chrono::seconds kSilence{3};

class FeedListener : public config::messages::MessageHandler {
 public:
  /// A daemon was heard that was not heard before.
  virtual void on_new_run(std::int64_t run_id, bool first) = 0;
  /// `count` messages of `channel` did not arrive.
  virtual void on_lost(const std::string& channel, std::int64_t count) = 0;
  /// No health for kSilence (`silent`), or health again.
  virtual void on_silence(bool silent) = 0;
  /// Anything else worth a line, at most once per cause.
  virtual void on_notice(const std::string& what) = 0;
};

class ListenFeed {
 public:
  /// Throws config::schema::Error when LCM cannot start on `url`.
  ListenFeed(const std::string& url, const std::string& prefix, bool with_samples,
             FeedListener& listener);
  ~ListenFeed();
  ListenFeed(const ListenFeed&) = delete;
  ListenFeed& operator=(const ListenFeed&) = delete;

  /// Handles what arrives within `timeout`. False at the end of a log.
  bool poll(std::chrono::milliseconds timeout);

 private:
  using Clock = std::chrono::steady_clock;
  struct Channel {
    std::int64_t next_seq = -1;  // -1 before the first message
    std::int64_t lost = 0;       // not yet reported
  };

  static void received(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                       ListenFeed* feed);
  void take(const std::string& channel, const void* data, int size);
  /// Waits for one message. False when there is none within the time.
  bool handle(std::chrono::milliseconds timeout, bool& more);
  void follow(const std::string& channel, std::int64_t run_id, std::int64_t seq);
  void watch();
  void tell_losses();

  const bool with_samples_;
  std::unique_ptr<config::messages::UdpReceiver> udp_;  ///< else:
  std::unique_ptr<lcm::LCM> lcm_;
  const std::string prefix_;
  const bool is_log_;
  FeedListener& listener_;
  std::map<std::string, Channel> channels_;
  std::set<std::int64_t> runs_;
  std::set<std::string> told_;  // causes of notices
  std::int64_t run_id_ = 0;
  bool silent_ = false;
  Clock::time_point last_health_;
  Clock::time_point last_losses_;
};

}  // namespace workbench::live
