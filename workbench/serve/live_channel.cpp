#include "workbench/serve/live_channel.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "config/schema/error.h"
#include "config/signals/nan.h"
#include "config/signals/quality.h"
#include "plant_sim/model_file.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "workbench/live/listen_feed.h"
#include "workbench/live/listen_lines.h"
#include "workbench/live/online_residual.h"
#include "workbench/present/json.h"
#include "workbench/serve/detectable.h"

namespace workbench::serve {
namespace {

using config::signals::kNaN;
using nlohmann::ordered_json;
using present::number_or_null;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kBatch{100};
constexpr std::chrono::seconds kStatus{1};
constexpr std::chrono::seconds kFigures{5};  ///< a comparison over the last half minute
constexpr std::chrono::seconds kRetry{1};
/// A page that loads itself again finds the last minute, and a trigger as it was.
constexpr std::chrono::seconds kLinger{15};
constexpr double kHistory_s = 60.0;
/// The longest capture at 10 kHz; 3 kHz for the whole history.
constexpr std::size_t kMostPoints = 200'000;
constexpr std::uint64_t kMostBatch = 4000;  ///< points; some 200 kB of text
constexpr std::size_t kMostSources = 50;

double seconds_since(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

class LiveListener final : public live::FeedListener {
 public:
  void on(const spoolwatch::sample_t& s) override {
    came_ = Clock::now();
    state_ = s.state;
    const bool good = !config::signals::is_stale(s.quality) && std::isfinite(s.y_m);
    LivePoint point{static_cast<double>(s.utc_us) * 1e-6,
                    s.reference_m,
                    good ? s.y_m : kNaN,
                    s.u_applied_V,
                    kNaN,
                    s.tick,
                    s.sample_time_s};
    if (s.gap > 0 && !points_.empty())
      append({point.t_s - s.sample_time_s, kNaN, kNaN, kNaN, kNaN});
    if (residual_ && good && std::isfinite(s.u_applied_V)) {
      try {
        residual_->add(s.tick, s.sample_time_s, s.u_applied_V, s.y_m);
        point.error_m = residual_->newest_error_m();
      } catch (const config::schema::Error& error) {
        model_note_ = error.what();
        residual_.reset();
      }
    }
    append(point);
  }
  void on(const spoolwatch::estimate_t& e) override {
    if (estimates_.size() < kMostSources || estimates_.count(e.source) > 0) {
      ordered_json& shown = estimates_[e.source];
      shown = ordered_json::parse(live::json(e), nullptr, false);
      shown["seen_down_ratio"] = shown["seen_up_ratio"] = ordered_json::array();
      for (std::size_t i = 0; e.valid && i < e.value.size(); ++i) {
        const DetectableChange seen =
            detectable_change(e.value[i], e.std_error[i], e.low[i], e.high[i]);
        shown["seen_down_ratio"].push_back(number_or_null(seen.down_ratio));
        shown["seen_up_ratio"].push_back(number_or_null(seen.up_ratio));
      }
    }
  }
  void on(const spoolwatch::alarm_t& a) override {
    const std::string name = a.source + "." + a.name;
    if (alarms_.size() < kMostSources || alarms_.count(name) > 0) {
      alarms_[name] = ordered_json::parse(live::json(a), nullptr, false);
    }
  }
  void on(const spoolwatch::health_t& h) override {
    state_ = h.state;
    health_ = ordered_json::parse(live::json(h), nullptr, false);
  }
  void on_new_run(std::int64_t, bool first) override {
    if (!first) notice_ = "the daemon was restarted";
    first_ = end();
    points_.clear();
    estimates_.clear();
    alarms_.clear();
    if (!first) restarted_ = true;
  }
  void on_lost(const std::string& channel, std::int64_t count) override {
    lost_ += count;
    if (channel.ends_with("_SAMPLE") && !points_.empty()) {
      append({points_.back().t_s, kNaN, kNaN, kNaN, kNaN});
    }
  }
  void on_silence(bool silent) override { silent_ = silent; }
  void on_notice(const std::string& what) override { notice_ = what; }

  void watch(const std::string& file) {
    residual_.reset();
    model_note_.clear();
    if (file.empty()) return;
    try {
      residual_.emplace(plant_sim::load_model(file));
    } catch (const config::schema::Error& error) {
      model_note_ = error.what();
    }
  }

  /// Points are numbered as they come; those from begin() on are kept.
  [[nodiscard]] std::uint64_t begin() const { return first_; }
  [[nodiscard]] std::uint64_t end() const { return first_ + points_.size(); }
  [[nodiscard]] double newest_s() const { return points_.back().t_s; }

  [[nodiscard]] std::vector<LivePoint> part(std::uint64_t from, std::uint64_t to) const {
    const auto first = points_.begin() + static_cast<std::ptrdiff_t>(from - first_);
    return {first, first + static_cast<std::ptrdiff_t>(to - from)};
  }

  void set_trigger(const TriggerSettings& settings) { trigger_ = Trigger(settings); }
  /// The newest capture since the last call; null: none.
  std::shared_ptr<const Capture> take_capture() { return std::exchange(capture_, nullptr); }
  [[nodiscard]] bool take_restarted() { return std::exchange(restarted_, false); }

  void update_model_figures() {
    model_figures_ = nullptr;
    if (residual_) model_figures_ = ordered_json::parse(live::json_of(residual_->figures()));
  }
  [[nodiscard]] ordered_json status() const {
    ordered_json out;
    out["age_s"] = came_ ? number_or_null(seconds_since(*came_)) : ordered_json(nullptr);
    out["silent"] = silent_;
    out["state"] = state_ < 0 ? ordered_json(nullptr) : ordered_json(live::state_text(state_));
    out["lost"] = lost_;
    out["notice"] = notice_;
    out["health"] = health_;
    out["estimates"] = ordered_json::array();
    for (const auto& [source, estimate] : estimates_) out["estimates"].push_back(estimate);
    out["alarms"] = ordered_json::array();
    for (const auto& [name, alarm] : alarms_) out["alarms"].push_back(alarm);
    out["model"] = model_figures_;
    out["model_note"] = model_note_;
    const TriggerSettings& trigger = trigger_.settings();
    out["trigger"] = {{"mode", to_string(trigger.mode)},  {"edge", to_string(trigger.edge)},
                      {"channel", trigger.channel},       {"level", trigger.level},
                      {"window_s", trigger.window_s},     {"before_ratio", trigger.before_ratio},
                      {"hold_off_s", trigger.hold_off_s}, {"state", trigger_.state()}};
    return out;
  }

 private:
  void append(const LivePoint& point) {
    points_.push_back(point);
    while (points_.size() > kMostPoints || points_.front().t_s < point.t_s - kHistory_s) {
      points_.pop_front();
      ++first_;
    }
    const double value = shown_value(point, trigger_.settings().channel);
    if (const auto span = trigger_.add(point.t_s, value)) capture(*span);
  }

  void capture(const Trigger::Span& span) {
    auto made = std::make_shared<Capture>();
    made->settings = trigger_.settings();
    made->span = span;
    for (const LivePoint& point : points_) {
      if (point.t_s >= span.from_s && point.t_s <= span.to_s) made->points.push_back(point);
    }
    made->lacks_s = lacking_s(*made);
    capture_ = std::move(made);
  }

  std::deque<LivePoint> points_;
  std::uint64_t first_ = 0;  ///< number of points_.front()
  std::optional<Clock::time_point> came_;
  int state_ = -1;
  bool silent_ = false;
  bool restarted_ = false;
  std::int64_t lost_ = 0;
  std::string notice_;
  ordered_json health_;
  std::map<std::string, ordered_json> estimates_, alarms_;
  std::optional<live::OnlineResidual> residual_;
  std::string model_note_;
  ordered_json model_figures_;
  Trigger trigger_;
  std::shared_ptr<const Capture> capture_;
};

struct Batch {
  std::vector<StreamId> pages;
  const char* name;
  std::string json;
};

/// How far each page is.
class Pages {
 public:
  /// Those that have come.
  std::vector<StreamId> set(const std::set<StreamId>& open) {
    std::erase_if(pages_, [&](const auto& page) { return open.count(page.first) == 0; });
    std::vector<StreamId> begin;
    for (const StreamId page : open) {
      if (pages_.try_emplace(page).second) begin.push_back(page);
    }
    return begin;
  }
  /// Another run: all that came before is of no use.
  void begin_again() {
    for (auto& [id, place] : pages_) place = {};
  }
  /// The points that the pages lack, at most kMostBatch for each; pages at the same place share
  /// one.
  std::vector<Batch> next(const LiveListener& listener) {
    std::map<Place, std::vector<StreamId>> places;
    for (const auto& [id, place] : pages_) places[place].push_back(id);
    std::vector<Batch> batches;
    for (auto& [place, ids] : places) {
      const std::uint64_t from = std::max(place.next, listener.begin());
      const std::uint64_t to = std::min(listener.end(), from + kMostBatch);
      if (from == to) continue;
      const Place then{to, true, place.caught_up || to == listener.end()};
      for (const StreamId id : ids) pages_[id] = then;
      const std::vector<LivePoint> points = listener.part(from, to);
      std::string json = "{";
      if (!place.caught_up) {
        json += fmt::format("\"to\":{:.6f},\"begins\":{},\"newest\":{:.6f},", points.back().t_s,
                            !place.begun, listener.newest_s());
      }
      json += columns_json(points, points.front().t_s) + "}";
      batches.push_back({std::move(ids), place.caught_up ? "samples" : "history", std::move(json)});
    }
    return batches;
  }

 private:
  struct Place {
    std::uint64_t next = 0;  ///< number of the first point that it lacks
    bool begun = false;
    bool caught_up = false;
    bool operator<(const Place& other) const {
      return std::tie(next, begun, caught_up) < std::tie(other.next, other.begun, other.caught_up);
    }
  };
  std::map<StreamId, Place> pages_;
};

std::string text_of(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

LiveChannel::LiveChannel(LiveOptions options, Publish publish, std::function<void()> every_second)
    : options_(std::move(options)),
      publish_(std::move(publish)),
      every_second_(std::move(every_second)),
      thread_([this] { run(); }) {}

void LiveChannel::end() {
  {
    const std::lock_guard lock(mutex_);
    wish_.ends = true;
  }
  wakes_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void LiveChannel::open(StreamId page) {
  {
    const std::lock_guard lock(mutex_);
    wish_.pages.insert(page);
  }
  wakes_.notify_one();
}

void LiveChannel::close(StreamId page) {
  const std::lock_guard lock(mutex_);
  wish_.pages.erase(page);
}

void LiveChannel::watch_model(std::string file) {
  const std::lock_guard lock(mutex_);
  wish_.model = std::move(file);
}

void LiveChannel::set_trigger(const TriggerSettings& settings) {
  const std::lock_guard lock(mutex_);
  wish_.trigger = settings;
  ++wish_.triggers_set;
}

std::shared_ptr<const Capture> LiveChannel::newest_capture() const {
  const std::lock_guard lock(mutex_);
  return capture_;
}

std::shared_ptr<const Capture> LiveChannel::number(const std::shared_ptr<const Capture>& capture) {
  auto numbered = std::make_shared<Capture>(*capture);
  const std::lock_guard lock(mutex_);
  numbered->number = ++captures_;
  capture_ = numbered;
  return numbered;
}

void LiveChannel::show_capture(const std::shared_ptr<const Capture>& capture,
                               const std::vector<StreamId>& pages) {
  if (capture && !pages.empty()) publish_(pages, "capture", to_json(*capture));
}

LiveChannel::Wish LiveChannel::wish() const {
  const std::lock_guard lock(mutex_);
  return wish_;
}

void LiveChannel::run() {
  while (true) {
    {
      std::unique_lock lock(mutex_);
      wakes_.wait(lock, [this] { return wish_.ends || !wish_.pages.empty(); });
      if (wish_.ends) return;
    }
    try {
      listen();
    } catch (const std::exception& error) {
      const ordered_json status{{"age_s", nullptr}, {"notice", error.what()}};
      const std::set<StreamId> pages = wish().pages;
      publish_({pages.begin(), pages.end()}, "status", text_of(status));
      std::unique_lock lock(mutex_);
      wakes_.wait_for(lock, kRetry, [this] { return wish_.ends; });
    }
  }
}

void LiveChannel::listen() {
  LiveListener listener;
  live::ListenFeed feed(options_.url, options_.prefix, true, listener);
  Pages pages;
  std::string model;
  std::uint64_t triggers_set = 0;
  Clock::time_point told{};
  Clock::time_point compared{};
  Clock::time_point watched = Clock::now();
  while (true) {
    const Wish now = wish();
    if (now.ends) return;
    if (!now.pages.empty()) watched = Clock::now();
    if (Clock::now() - watched > kLinger) return;
    if (now.model != model) {
      model = now.model;
      listener.watch(model);
    }
    if (now.triggers_set != triggers_set) {
      triggers_set = now.triggers_set;
      listener.set_trigger(now.trigger);
      told = {};
    }
    const bool more = feed.poll(kBatch);
    if (listener.take_restarted()) pages.begin_again();
    const std::vector<StreamId> begin = pages.set(now.pages);
    if (!begin.empty()) told = {};
    for (const Batch& batch : pages.next(listener)) publish_(batch.pages, batch.name, batch.json);
    show_capture(newest_capture(), begin);
    if (const auto made = listener.take_capture()) {
      show_capture(number(made), {now.pages.begin(), now.pages.end()});
      told = {};
    }
    if (!now.pages.empty() && Clock::now() - told >= kStatus) {
      told = Clock::now();
      if (told - compared >= kFigures) {
        compared = told;
        listener.update_model_figures();
      }
      publish_({now.pages.begin(), now.pages.end()}, "status", text_of(listener.status()));
      every_second_();
    }
    // After the end of a log its last picture stays.
    if (!more) std::this_thread::sleep_for(kBatch);
  }
}

}  // namespace workbench::serve
