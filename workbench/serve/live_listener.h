// The newest samples, estimates, alarms and health of a daemon, as its messages bring them, with
// the model that runs beside the samples and the trigger that looks at them. Used by one thread,
// which prints the axis of that model.
#pragma once

#include <algorithm>
#include <bitset>
#include <chrono>
#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/schema/error.h"
#include "config/signals/quality.h"
#include "plant_sim/model_file.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "workbench/live/listen_feed.h"
#include "workbench/live/listen_lines.h"
#include "workbench/live/online_residual.h"
#include "workbench/present/json.h"
#include "workbench/present/printed_axis.h"
#include "workbench/present/text.h"
#include "workbench/serve/live_estimate.h"
#include "workbench/serve/live_points.h"
#include "workbench/serve/trigger.h"

namespace workbench::serve {

class LiveListener final : public live::FeedListener {
 public:
  void on(const spoolwatch::sample_t& s) override {
    came_ = std::chrono::steady_clock::now();
    state_ = s.state;
    const bool good = !config::signals::is_stale(s.quality) && std::isfinite(s.y_m);
    LivePoint point{.t_s = static_cast<double>(s.utc_us) * 1e-6,
                    .tick = s.tick,
                    .sample_time_s = s.sample_time_s};
    point.values[kReference] = s.reference_m;
    if (good) point.values[kPosition] = s.y_m;
    point.values[kCommand] = s.u_applied_V;
    point.values[kRequested] = s.u_requested_V;
    if (tells_of(pressures_, s)) {
      point.values[kSupply] = pressures_.supply_Pa;
      point.values[kPressureIn] = pressures_.in_Pa;
      point.values[kPressureOut] = pressures_.out_Pa;
    }
    if (tells_of(rods_, s)) {
      const std::size_t rods = std::min(rods_.y_m.size(), config::signals::kMaxRods);
      for (std::size_t i = 0; i < rods; ++i) point.values.at(kFirstRod + i) = rods_.y_m[i];
    }
    if (s.gap > 0 && !points_.empty()) append({.t_s = point.t_s - s.sample_time_s});
    if (residual_ && good && std::isfinite(s.u_applied_V)) {
      try {
        residual_->add(s.tick, s.sample_time_s, s.u_applied_V, s.y_m);
        point.values[kModelError] = residual_->newest_error_m();
      } catch (const config::schema::Error& error) {
        model_note_ = error.what();
        residual_.reset();
      }
    }
    append(point);
  }
  // The daemon sends pressures and single rods just before the sample that they belong to.
  void on(const spoolwatch::rods_t& rods) override { rods_ = rods; }
  void on(const spoolwatch::pressures_t& pressures) override { pressures_ = pressures; }
  void on(const spoolwatch::estimate_t& e) override {
    if (estimates_.size() < kMostSources || estimates_.count(e.source) > 0) {
      estimates_[e.source] = live_estimate(e);
    }
  }
  void on(const spoolwatch::alarm_t& a) override {
    const std::string name = a.source + "." + a.name;
    if (alarms_.size() < kMostSources || alarms_.count(name) > 0) {
      alarms_[name] = nlohmann::ordered_json::parse(live::json(a), nullptr, false);
    }
  }
  void on(const spoolwatch::health_t& h) override {
    state_ = h.state;
    health_ = nlohmann::ordered_json::parse(live::json(h), nullptr, false);
  }
  void on_new_run(std::int64_t, bool first) override {
    if (!first) notice_ = "the daemon was restarted";
    first_ = end();
    points_.clear();
    there_ = kAlwaysThere;
    estimates_.clear();
    alarms_.clear();
    if (!first) restarted_ = true;
  }
  void on_lost(const std::string& channel, std::int64_t count) override {
    lost_ += count;
    if (channel.ends_with("_SAMPLE") && !points_.empty()) {
      append({.t_s = points_.back().t_s});
    }
  }
  void on_silence(bool silent) override { silent_ = silent; }
  void on_notice(const std::string& what) override { notice_ = what; }

  void watch(const std::string& file) {
    residual_.reset();
    model_note_.clear();
    motion_ = config::units::Motion::linear;
    if (file.empty()) return;
    try {
      const plant_sim::ModelFile model = plant_sim::load_model(file);
      motion_ = present::motion_of(model);
      residual_.emplace(model);
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

  /// Of the axis of the model beside the stand.
  [[nodiscard]] config::units::Motion motion() const { return motion_; }
  /// Columns that had a value in this run, and those that every stand has.
  [[nodiscard]] LiveChoice choice() const {
    LiveChoice choice;
    for (std::size_t i = 0; i < kLiveColumns; ++i) {
      if (there_[i]) choice.push_back(static_cast<LiveColumn>(i));
    }
    return choice;
  }

  void set_trigger(const TriggerSettings& settings) {
    trigger_ = Trigger(settings);
    trigger_column_ = column_of(settings.channel).value_or(kPosition);
  }
  /// The newest capture since the last call; null: none.
  std::shared_ptr<const Capture> take_capture() { return std::exchange(capture_, nullptr); }
  [[nodiscard]] bool take_restarted() { return std::exchange(restarted_, false); }

  void update_model_figures() {
    model_figures_ = nullptr;
    if (!residual_) return;
    const live::ResidualFigures figures = residual_->figures();
    model_figures_ = nlohmann::ordered_json::parse(live::json_of(figures));
    add_words(model_figures_);
    nlohmann::ordered_json& worst = model_figures_["worst"];
    if (!worst.is_object()) return;
    add_words(worst);
    worst["where"] = present::typeset(worst["where"].get<std::string>());
    worst["spans"] = nlohmann::ordered_json::array();
    const auto newest = std::find_if(points_.rbegin(), points_.rend(),
                                     [](const LivePoint& point) { return point.tick >= 0; });
    if (newest == points_.rend()) return;
    const double began_s = newest->t_s - static_cast<double>(newest->tick) * newest->sample_time_s;
    for (const compare::TimeSpan& span : figures.worst_spans) {
      worst["spans"].push_back({began_s + span.from_s, began_s + span.to_s});
    }
  }
  [[nodiscard]] nlohmann::ordered_json status() const {
    nlohmann::ordered_json out;
    out["age_s"] =
        came_
            ? present::number_or_null(
                  std::chrono::duration<double>(std::chrono::steady_clock::now() - *came_).count())
            : nlohmann::ordered_json(nullptr);
    out["silent"] = silent_;
    out["state"] = state_ < 0 ? nlohmann::ordered_json(nullptr)
                              : nlohmann::ordered_json(live::state_text(state_));
    out["lost"] = lost_;
    out["notice"] = notice_;
    out["health"] = health_;
    out["estimates"] = nlohmann::ordered_json::array();
    for (const auto& [source, estimate] : estimates_) out["estimates"].push_back(estimate);
    out["alarms"] = nlohmann::ordered_json::array();
    for (const auto& [name, alarm] : alarms_) out["alarms"].push_back(alarm);
    out["model"] = model_figures_;
    out["model_note"] = model_note_;
    const TriggerSettings& trigger = trigger_.settings();
    out["channels"] = nlohmann::ordered_json::array();
    for (const LiveColumn column : choice()) {
      out["channels"].push_back({{"key", key_of(column)},
                                 {"words", words(column)},
                                 {"plot", plot_of(column)},
                                 {"unit", shown_unit(column)}});
    }
    out["trigger"] = {{"mode", to_string(trigger.mode)},  {"edge", to_string(trigger.edge)},
                      {"channel", trigger.channel},       {"level", trigger.level},
                      {"window_s", trigger.window_s},     {"before_ratio", trigger.before_ratio},
                      {"hold_off_s", trigger.hold_off_s}, {"state", trigger_.state()}};
    return out;
  }

 private:
  static constexpr double kHistory_s = 60.0;
  /// The longest capture at 10 kHz; 3 kHz for the whole history.
  static constexpr std::size_t kMostPoints = 200'000;
  static constexpr std::size_t kMostSources = 50;

  /// "rms" beside "rms_m", as it is printed.
  static void add_words(nlohmann::ordered_json& figures) {
    const nlohmann::ordered_json& rms_m = figures["rms_m"];
    figures["rms"] = rms_m.is_number()
                         ? present::typeset(config::units::length_words(rms_m.get<double>()))
                         : "-";
  }
  /// A message beside a sample belongs to it when both name the same tick of the same run.
  template <class Message>
  static bool tells_of(const Message& message, const spoolwatch::sample_t& sample) {
    return message.run_id == sample.run_id && message.tick == sample.tick;
  }

  /// A rod by the name that the rig gives it.
  [[nodiscard]] std::string words(LiveColumn column) const {
    const std::size_t rod = column - kFirstRod;
    const bool named = column >= kFirstRod && rod < rods_.rod.size() && !rods_.rod[rod].empty();
    return named ? config::units::moving_part() + " " + rods_.rod[rod] : words_of(column);
  }

  void append(const LivePoint& point) {
    points_.push_back(point);
    for (std::size_t i = 0; i < kLiveColumns; ++i) {
      if (std::isfinite(point.values[i])) there_.set(i);
    }
    while (points_.size() > kMostPoints || points_.front().t_s < point.t_s - kHistory_s) {
      points_.pop_front();
      ++first_;
    }
    const double value = shown_value(point, trigger_column_);
    if (const auto span = trigger_.add(point.t_s, value)) capture(*span);
  }

  void capture(const Trigger::Span& span) {
    auto made = std::make_shared<Capture>();
    made->settings = trigger_.settings();
    made->span = span;
    made->choice = choice();
    for (const LivePoint& point : points_) {
      if (point.t_s >= span.from_s && point.t_s <= span.to_s) made->points.push_back(point);
    }
    made->lacks_s = lacking_s(*made);
    capture_ = std::move(made);
  }

  static constexpr std::bitset<kLiveColumns> kAlwaysThere{1U << kReference | 1U << kPosition |
                                                          1U << kCommand | 1U << kModelError};

  std::deque<LivePoint> points_;
  std::bitset<kLiveColumns> there_ = kAlwaysThere;
  spoolwatch::rods_t rods_{};  ///< the newest
  spoolwatch::pressures_t pressures_{};
  std::uint64_t first_ = 0;  ///< number of points_.front()
  std::optional<std::chrono::steady_clock::time_point> came_;
  int state_ = -1;
  bool silent_ = false;
  bool restarted_ = false;
  std::int64_t lost_ = 0;
  std::string notice_;
  nlohmann::ordered_json health_;
  std::map<std::string, nlohmann::ordered_json> estimates_, alarms_;
  std::optional<live::OnlineResidual> residual_;
  std::string model_note_;
  nlohmann::ordered_json model_figures_;
  config::units::Motion motion_ = config::units::Motion::linear;
  Trigger trigger_;
  LiveColumn trigger_column_ = kPosition;
  std::shared_ptr<const Capture> capture_;
};

}  // namespace workbench::serve
