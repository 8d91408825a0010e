#include "workbench/serve/live_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "config/schema/error.h"
#include "config/signals/nan.h"
#include "workbench/present/plot_data.h"
#include "workbench/present/script_json.h"

namespace workbench::serve {
namespace {

constexpr std::array kChannels{"reference", "y", "u", "error"};
constexpr std::size_t kMostRows = 4000;  ///< of a capture on the page

}  // namespace

double shown_value(const LivePoint& point, const std::string& channel) {
  if (channel == "reference") return 1e3 * point.reference_m;
  if (channel == "y") return 1e3 * point.y_m;
  if (channel == "u") return point.u_V;
  return channel == "error" ? 1e6 * point.error_m : config::signals::kNaN;
}

std::string columns_json(const std::vector<LivePoint>& points, double t0_s) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const LivePoint& point : points) values.push_back(point.t_s - t0_s);
  std::string json = fmt::format("\"t0\":{:.6f},\"t\":", t0_s) + present::json_numbers(values);
  for (const std::string channel : kChannels) {
    values.clear();
    for (const LivePoint& point : points) values.push_back(shown_value(point, channel));
    json += ",\"" + channel + "\":" + present::json_numbers(values);
  }
  return json;
}

double lacking_s(const Capture& capture) {
  const auto first = std::find_if(capture.points.begin(), capture.points.end(),
                                  [](const LivePoint& point) { return point.tick >= 0; });
  if (first == capture.points.end()) return capture.span.to_s - capture.span.from_s;
  // The stamps of two samples may be further apart than a period.
  constexpr double kPeriods = 1.5;
  const double lacks_s = first->t_s - capture.span.from_s;
  return lacks_s > kPeriods * first->sample_time_s ? lacks_s : 0.0;
}

std::string to_json(const Capture& capture) {
  std::array<std::vector<double>, kChannels.size()> columns;
  std::vector<const std::vector<double>*> all;
  for (std::size_t i = 0; i < kChannels.size(); ++i) {
    for (const LivePoint& point : capture.points) {
      columns[i].push_back(shown_value(point, kChannels[i]));
    }
    all.push_back(&columns[i]);
  }
  std::vector<LivePoint> drawn;
  for (const std::size_t row : present::thin_lines(all, capture.points.size(), kMostRows)) {
    drawn.push_back(capture.points[row]);
  }
  const TriggerSettings& s = capture.settings;
  return fmt::format(
             "{{\"number\":{},\"channel\":{},\"level\":{},\"lacks_s\":{:.4g},\"from\":{},\"to\":{},"
             "\"samples\":{},",
             capture.number, present::json_string(s.channel), present::json_number(s.level),
             capture.lacks_s, present::json_number(capture.span.from_s - capture.span.at_s),
             present::json_number(capture.span.to_s - capture.span.at_s), capture.points.size()) +
         columns_json(drawn, capture.span.at_s) + "}";
}

config::record::Record record_of(const Capture& capture) {
  config::record::Record record;
  std::vector<double> reference_m;
  std::int64_t last_tick = -1;
  for (const LivePoint& point : capture.points) {
    const bool usable = point.tick >= 0 && std::isfinite(point.y_m) && std::isfinite(point.u_V);
    if (!usable) continue;
    if (last_tick >= 0 && point.tick != last_tick + 1) record.gaps.push_back(record.t_s.size());
    last_tick = point.tick;
    record.sample_time_s = point.sample_time_s;
    record.t_s.push_back(static_cast<double>(point.tick) * point.sample_time_s);
    record.u_V.push_back(point.u_V);
    record.y_m.push_back(point.y_m);
    reference_m.push_back(point.reference_m);
  }
  if (record.t_s.empty()) throw config::schema::UsageError("the capture has no usable sample");
  record.further.emplace_back("reference_m", std::move(reference_m));
  return record;
}

}  // namespace workbench::serve
