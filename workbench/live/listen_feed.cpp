#include "workbench/live/listen_feed.h"

#include <cerrno>

#include "config/messages/connect.h"
#include "config/messages/dispatch.h"

namespace workbench::live {
namespace {

// Messages that may wait while the terminal is slow: 10 s of samples with all that goes with them.
constexpr int kQueued = 6000;
constexpr std::chrono::seconds kTellLosses{1};

}  // namespace

ListenFeed::ListenFeed(const std::string& url, const std::string& prefix, bool with_samples,
                       FeedListener& listener)
    : lcm_(config::messages::connect(url)),
      prefix_(prefix),
      is_log_(url.starts_with("file:")),
      listener_(listener),
      last_health_(Clock::now()),
      last_losses_(last_health_) {
  const std::string kinds =
      with_samples ? "(SAMPLE|RODS|PRESSURES|ESTIMATE|ALARM|HEALTH)" : "(ESTIMATE|ALARM|HEALTH)";
  auto* subscription = lcm_->subscribeFunction(prefix_ + "_" + kinds, &ListenFeed::received, this);
  if (subscription == nullptr) {
    throw config::schema::bad_config("LCM URL \"" + url + "\"", "LCM cannot receive on it");
  }
  subscription->setQueueCapacity(kQueued);
}

ListenFeed::~ListenFeed() { tell_losses(); }

bool ListenFeed::poll(std::chrono::milliseconds timeout) {
  const auto until = Clock::now() + timeout;
  bool more = true;
  for (auto left = timeout; left.count() >= 0;
       left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now())) {
    const int handled = lcm_->handleTimeout(static_cast<int>(left.count()));
    if (handled > 0) continue;
    more = handled == 0 || (!is_log_ && errno == EINTR);
    break;
  }
  watch();
  return more;
}

void ListenFeed::received(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                          ListenFeed* feed) {
  using config::messages::MessageKind;
  const MessageKind kind =
      config::messages::kind_of(channel, feed->prefix_).value_or(MessageKind::health);
  const auto take = [&](const auto& message) {
    feed->follow(channel, message.run_id, message.seq);
    if (kind == MessageKind::health) {
      feed->last_health_ = Clock::now();
      feed->watch();
    }
    feed->listener_.on(message);
  };
  if (!config::messages::dispatch(kind, buffer->data, static_cast<int>(buffer->data_size), take) &&
      feed->told_.insert(channel).second) {
    feed->listener_.on_notice("messages of another type on channel " + channel +
                              " are left out (another version of the daemon?)");
  }
}

void ListenFeed::follow(const std::string& channel, std::int64_t run_id, std::int64_t seq) {
  if (runs_.empty() || run_id != run_id_) {
    const bool first = runs_.empty();
    if (runs_.insert(run_id).second) {
      listener_.on_new_run(run_id, first);
    } else if (told_.insert("two").second) {
      listener_.on_notice("two daemons send on the same channels; give each its own prefix or URL");
    }
    run_id_ = run_id;
    for (auto& [name, state] : channels_) state.next_seq = -1;
  }
  Channel& state = channels_[channel];
  if (state.next_seq >= 0 && seq > state.next_seq) state.lost += seq - state.next_seq;
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
