// A tracking for the terminal.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "config/units/quantity.h"
#include "estimator/fdi/tracker/tracking_text.h"
#include "workbench/isolate/isolation.h"

namespace workbench::isolate {

namespace greybox = estimator::greybox;
namespace tracker = estimator::fdi::tracker;
namespace {

using config::units::length_words;

std::string pressure(double value_Pa) {
  return config::units::words(config::units::quantity("pressure_Pa", value_Pa, NAN));
}

std::string seconds(double s) { return fmt::format("{:.4g} s", s); }

std::string healthy_line(const IsolationReport& o) {
  std::string text = "healthy";
  text += o.learnt ? fmt::format(" ({:.4g} to ", o.baseline_from_s) + seconds(o.baseline_to_s) + ")"
                   : " (given)";
  text += ": error " + length_words(o.baseline.rms_m) + ", noise floor " +
          length_words(o.noise_floor_m);
  const tracking::ChamberErrors& chambers = o.baseline.chambers;
  if (chambers.known()) {
    text += ", pressures in " + pressure(chambers.in.rms_Pa) + " and out " +
            pressure(chambers.out.rms_Pa);
  }
  for (std::size_t i = 0; i < o.set.tracked; ++i) {
    const greybox::FreeParameter& p = o.set.parameters[i];
    text += ", " + tracker::name_words(p.name) + " " +
            tracker::value_words(p, o.baseline.theta[static_cast<Eigen::Index>(i)], NAN);
  }
  return text + "\n";
}

std::string disturbance_lines(const IsolationReport& o) {
  if (!o.baseline.noise) return {};
  const tracking::ProcessNoise& noise = *o.baseline.noise;
  std::string text = "disturbed: " + tracker::disturbance_words(noise, noise.healthy) + "\n";
  text += "healthy values known to";
  for (std::size_t i = 0; i < o.set.tracked; ++i) {
    const greybox::FreeParameter& p = o.set.parameters[i];
    const auto at = static_cast<Eigen::Index>(i);
    text += (i == 0 ? " " : ", ") + tracker::name_words(p.name) + " " +
            tracker::value_words(p, o.baseline.theta[at], std::sqrt(noise.covariance(at, at)));
  }
  const WindowResult* const last = o.windows.empty() ? nullptr : &o.windows.back();
  if (last != nullptr && last->level) {
    text += "\ndisturbed at the end: " + tracker::disturbance_words(noise, *last->level);
  }
  return text + "\n";
}

std::string alarm_lines(const IsolationReport& o, const DetectedChange& alarm) {
  std::string text = "ALARM " + seconds(alarm.raised_s) +
                     (alarm.active() ? "" : " to " + seconds(alarm.cleared_s)) + ": " +
                     tracker::change_words(o.set, alarm.named, o.baseline.theta) +
                     fmt::format(" (confidence {:.4f})\n", std::min(alarm.confidence, 0.9999));
  const std::string group = tracker::group_words(o.set, alarm.named);
  return group.empty() ? text : text + "      " + group + "\n";
}

/// Up to the first figures: reasons that differ in figures only are one.
std::string kind_of(const std::string& why) { return why.substr(0, why.find_first_of(":(")); }

/// One line per kind of text that `words` gives for the windows.
std::string kind_lines(const IsolationReport& o,
                       const std::function<std::string(const WindowResult&)>& words) {
  std::map<std::string, std::pair<int, const WindowResult*>> kinds;
  for (const WindowResult& window : o.windows) {
    const std::string said = words(window);
    if (said.empty()) continue;
    auto& kind = kinds[kind_of(said)];
    if (kind.first++ == 0) kind.second = &window;
  }
  std::string text;
  for (const auto& [name, kind] : kinds) {
    text += "  " + std::to_string(kind.first) + ", the first at " + seconds(kind.second->t_s) +
            ": " + words(*kind.second) + "\n";
  }
  return text;
}

std::string window_lines(const IsolationReport& o) {
  const auto invalid = std::count_if(o.windows.begin(), o.windows.end(),
                                     [](const WindowResult& window) { return !window.valid; });
  const auto left_out =
      std::count_if(o.windows.begin(), o.windows.end(),
                    [](const WindowResult& window) { return static_cast<bool>(window.left_out); });
  const std::string length = o.baseline.noise ? "up to " + seconds(o.settings.disturbed_window_s)
                                              : seconds(o.settings.window_s);
  std::string text = std::to_string(o.windows.size()) + " windows of " + length + ", " +
                     std::to_string(invalid) + " invalid\n" +
                     kind_lines(o, [&o](const WindowResult& window) {
                       return tracker::invalid_words(o.set, window.invalid);
                     });
  if (left_out > 0) {
    text += std::to_string(left_out) + " windows by position alone\n" +
            kind_lines(o, [](const WindowResult& window) {
              return tracker::left_out_words(window.left_out);
            });
  }
  return text;
}

std::string window_line(const IsolationReport& o, const WindowResult& window) {
  std::string text = fmt::format("{:9.3f} s ", window.t_s);
  for (std::size_t i = 0; i < o.set.tracked; ++i) {
    const greybox::FreeParameter& p = o.set.parameters[i];
    const tracking::ParameterEstimate& estimate = window.estimates[i];
    text += " " + config::units::words(
                      config::units::quantity(p.name, estimate.value, estimate.std_error));
    text += i + 1 < o.set.tracked ? "," : "";
  }
  text += ", error " + length_words(window.rms_m);
  if (!window.valid) text += "; INVALID, " + tracker::invalid_words(o.set, window.invalid);
  if (window.left_out) text += "; " + tracker::left_out_words(window.left_out);
  if (window.part) text += "; " + tracker::part_words(o.set, *window.part);
  return text + "\n";
}

}  // namespace

std::string to_text(const IsolationReport& o, bool all_windows) {
  std::string text = healthy_line(o) + disturbance_lines(o);
  for (const std::string& note : o.notes) text += "note: " + note + "\n";
  for (const DetectedChange& alarm : o.alarms) text += alarm_lines(o, alarm);
  if (o.alarms.empty()) text += "no change named\n";
  text += window_lines(o);
  if (all_windows) {
    for (const WindowResult& window : o.windows) text += window_line(o, window);
  }
  return text;
}

}  // namespace workbench::isolate
