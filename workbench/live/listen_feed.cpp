#include "workbench/live/listen_feed.h"

#include <cerrno>

#include "config/messages/connect.h"
#include "config/messages/dispatch.h"
#include "config/messages/plausible.h"

namespace workbench::live {
namespace {

// Messages that may wait while the terminal is slow: 10 s of samples with all that goes with them.
constexpr int kQueued = 6000;
constexpr std::chrono::seconds kTellLosses{1};
constexpr std::int64_t kMostSeq = std::int64_t{1} << 60;
constexpr std::int64_t kMostLost = 10'000'000;
constexpr std::size_t kMostRuns = 1000;  // remembered

using config::messages::MessageKind;

/// Without samples and what goes with them.
bool is_for_listeners(MessageKind kind) {
  return kind == MessageKind::estimate || kind == MessageKind::alarm || kind == MessageKind::health;
}

}  // namespace

ListenFeed::ListenFeed(const std::string& url, const std::string& prefix, bool with_samples,
                       FeedListener& listener)
    : with_samples_(with_samples),
      prefix_(prefix),
      is_log_(url.starts_with("file:")),
      listener_(listener),
      last_health_(Clock::now()),
      last_losses_(last_health_) {
  if (config::messages::is_udp(url)) {
    udp_ = std::make_unique<config::messages::UdpReceiver>(
        url, [prefix, with_samples](const std::string& channel) {
          const auto kind = config::messages::kind_of(channel, prefix);
          return kind && (with_samples || is_for_listeners(*kind));
        });
    return;
  }
  lcm_ = config::messages::connect(url);
  auto* subscription = lcm_->subscribeFunction(prefix_ + "_.*", &ListenFeed::received, this);
  if (subscription == nullptr) {
    throw config::schema::bad_config("LCM URL \"" + url + "\"", "LCM cannot receive on it");
  }
  subscription->setQueueCapacity(kQueued);
}

ListenFeed::~ListenFeed() { tell_losses(); }

bool ListenFeed::handle(std::chrono::milliseconds timeout, bool& more) {
  if (udp_) {
    const auto message = udp_->next(timeout);
    if (message) {
      take(message->channel, message->payload.data(), static_cast<int>(message->payload.size()));
    }
    return message.has_value();
  }
  const int handled = lcm_->handleTimeout(static_cast<int>(timeout.count()));
  more = handled > 0 || handled == 0 || (!is_log_ && errno == EINTR);
  return handled > 0;
}

bool ListenFeed::poll(std::chrono::milliseconds timeout) {
  const auto until = Clock::now() + timeout;
  bool more = true;
  for (auto left = timeout; left.count() >= 0;
       left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now())) {
    if (!handle(left, more)) break;
  }
  watch();
  return more;
}

void ListenFeed::received(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                          ListenFeed* feed) {
  feed->take(channel, buffer->data, static_cast<int>(buffer->data_size));
}

void ListenFeed::take(const std::string& channel, const void* data, int size) {
  const auto kind = config::messages::kind_of(channel, prefix_);
  if (!kind || !(with_samples_ || is_for_listeners(*kind))) return;
  const auto take = [&](const auto& message) {
    if (!config::messages::plausible(message)) {
      if (told_.insert("implausible").second) {
        listener_.on_notice("implausible messages on channel " + channel +
                            " are left out (damaged on the way?)");
      }
      return;
    }
    follow(channel, message.run_id, message.seq);
    if (*kind == MessageKind::health) {
      last_health_ = Clock::now();
      watch();
    }
    listener_.on(message);
  };
  if (!config::messages::dispatch(*kind, data, size, take) && told_.insert(channel).second) {
    listener_.on_notice("messages of another type on channel " + channel +
                        " are left out (another version of the daemon?)");
  }
}

void ListenFeed::follow(const std::string& channel, std::int64_t run_id, std::int64_t seq) {
  if (runs_.empty() || run_id != run_id_) {
    const bool first = runs_.empty();
    if (runs_.size() >= kMostRuns) runs_.erase(runs_.begin());
    if (runs_.insert(run_id).second) {
      listener_.on_new_run(run_id, first);
    } else if (told_.insert("two").second) {
      listener_.on_notice("two daemons send on the same channels; give each its own prefix or URL");
    }
    run_id_ = run_id;
    for (auto& [name, state] : channels_) state.next_seq = -1;
  }
  Channel& state = channels_[channel];
  // A number that jumps further was damaged on the way; the next message says how it goes on.
  if (seq < 0 || seq > kMostSeq) return;
  const std::int64_t gap = seq - state.next_seq;
  if (state.next_seq >= 0 && gap > 0 && gap <= kMostLost) state.lost += gap;
  state.next_seq = seq + 1;
}

void ListenFeed::watch() {
  const auto now = Clock::now();
  if (now - last_losses_ >= kTellLosses) {
    last_losses_ = now;
    tell_losses();
  }
  const bool silent = !is_log_ && now - last_health_ >= kSilence;
  if (silent != silent_) {
    silent_ = silent;
    listener_.on_silence(silent);
  }
}

void ListenFeed::tell_losses() {
  for (auto& [name, state] : channels_) {
    if (state.lost > 0) listener_.on_lost(name, state.lost);
    state.lost = 0;
  }
}

}  // namespace workbench::live
