#include "workbench/serve/live_channel.h"

#include <chrono>
#include <cmath>
#include <deque>
#include <map>
#include <optional>

#include "config/schema/error.h"
#include "config/signals/nan.h"
#include "plant_sim/model_file.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "workbench/live/listen_feed.h"
#include "workbench/live/listen_lines.h"
#include "workbench/live/online_residual.h"
#include "workbench/present/json.h"

namespace workbench::serve {
namespace {

using config::signals::kNaN;
using nlohmann::ordered_json;
using present::number_or_null;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kBatch{100};
constexpr std::chrono::seconds kStatus{1};
constexpr std::chrono::seconds kFigures{3};  ///< a comparison over the last half minute
constexpr std::chrono::seconds kRetry{1};
constexpr double kHistory_s = 60.0;
constexpr std::size_t kMostPoints = 60 * 1000;  ///< a kilohertz for the whole history
constexpr std::int8_t kStaleQuality = 2;        ///< and 3, bad: no new reading
constexpr std::size_t kMostSources = 50;

struct Point {
  double t_s, reference_m, y_m, u_V, error_m;
};

double seconds_since(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

class LiveListener final : public live::FeedListener {
 public:
  void on(const spoolwatch::sample_t& s) override {
    came_ = Clock::now();
    state_ = s.state;
    const bool good = s.quality < kStaleQuality && std::isfinite(s.y_m);
    Point point{static_cast<double>(s.utc_us) * 1e-6, s.reference_m, good ? s.y_m : kNaN,
                s.u_applied_V, kNaN};
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
      estimates_[e.source] = ordered_json::parse(live::json(e), nullptr, false);
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
    points_.clear();
    fresh_ = 0;
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

  /// The newest `count` points, column by column.
  [[nodiscard]] ordered_json columns(std::size_t count) const {
    ordered_json t = ordered_json::array(), reference = t, y = t, u = t, error = t;
    for (std::size_t i = points_.size() - std::min(count, points_.size()); i < points_.size();
         ++i) {
      const Point& p = points_[i];
      t.push_back(p.t_s);
      reference.push_back(number_or_null(1e3 * p.reference_m));
      y.push_back(number_or_null(1e3 * p.y_m));
      u.push_back(number_or_null(p.u_V));
      error.push_back(number_or_null(1e6 * p.error_m));
    }
    return {{"t", t}, {"reference", reference}, {"y", y}, {"u", u}, {"error", error}};
  }
  [[nodiscard]] ordered_json history() const { return columns(points_.size()); }
  [[nodiscard]] std::size_t fresh() const { return fresh_; }
  ordered_json take_fresh() { return columns(std::exchange(fresh_, 0)); }
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
    return out;
  }

 private:
  void append(const Point& point) {
    points_.push_back(point);
    ++fresh_;
    while (points_.size() > kMostPoints || points_.front().t_s < point.t_s - kHistory_s) {
      points_.pop_front();
    }
  }

  std::deque<Point> points_;
  std::size_t fresh_ = 0;
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
};

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

void LiveChannel::want(bool wanted) {
  {
    const std::lock_guard lock(mutex_);
    wish_.wanted = wanted;
    if (wanted) ++wish_.pages;
  }
  wakes_.notify_one();
}

void LiveChannel::watch_model(std::string file) {
  const std::lock_guard lock(mutex_);
  wish_.model = std::move(file);
}

LiveChannel::Wish LiveChannel::wish() const {
  const std::lock_guard lock(mutex_);
  return wish_;
}

void LiveChannel::run() {
  while (true) {
    {
      std::unique_lock lock(mutex_);
      wakes_.wait(lock, [this] { return wish_.ends || wish_.wanted; });
      if (wish_.ends) return;
    }
    try {
      listen();
    } catch (const std::exception& error) {
      publish_("status", {{"age_s", nullptr}, {"notice", error.what()}});
      std::unique_lock lock(mutex_);
      wakes_.wait_for(lock, kRetry, [this] { return wish_.ends; });
    }
  }
}

void LiveChannel::listen() {
  LiveListener listener;
  live::ListenFeed feed(options_.url, options_.prefix, true, listener);
  std::string model;
  std::uint64_t pages = 0;
  Clock::time_point told{};
  Clock::time_point compared{};
  while (true) {
    const Wish now = wish();
    if (now.ends || !now.wanted) return;
    if (now.model != model) {
      model = now.model;
      listener.watch(model);
    }
    const bool more = feed.poll(kBatch);
    if (now.pages != pages || listener.take_restarted()) {
      pages = now.pages;
      (void)listener.take_fresh();
      publish_("history", listener.history());
      told = {};
    } else if (listener.fresh() > 0) {
      publish_("samples", listener.take_fresh());
    }
    if (Clock::now() - told >= kStatus) {
      told = Clock::now();
      if (told - compared >= kFigures) {
        compared = told;
        listener.update_model_figures();
      }
      publish_("status", listener.status());
      every_second_();
    }
    // After the end of a log its last picture stays.
    if (!more) std::this_thread::sleep_for(kBatch);
  }
}

}  // namespace workbench::serve
