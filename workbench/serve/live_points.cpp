#include "workbench/serve/live_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "config/record/sample_columns.h"
#include "config/schema/error.h"
#include "config/units/printed_scale.h"
#include "config/units/quantity.h"
#include "workbench/present/plot_data.h"
#include "workbench/present/script_json.h"

namespace workbench::serve {
namespace {

constexpr std::size_t kMostRows = 4000;  ///< of a capture on the page

struct ColumnText {
  const char* key;
  const char* column;  ///< of a record; its ending is the unit
  const char* words;
  const char* plot;
  double size;  ///< the unit is that of a quantity so large, SI
};

constexpr const char* kMotionPlot = "position";
constexpr const char* kCommandPlot = "command";
constexpr const char* kErrorPlot = "model error";
constexpr const char* kPressurePlot = "pressure";

constexpr std::array<ColumnText, kFirstRod> kTexts{{
    {"reference", "reference_m", "reference", kMotionPlot, 0.1},
    {"y", "y_m", "measured", kMotionPlot, 0.1},
    {"u_requested", "u_requested_V", "requested", kCommandPlot, 1.0},
    {"u", "u_V", "command", kCommandPlot, 1.0},
    {"error", "model_error_m", "measured less model", kErrorPlot, 1e-5},
    {"supply", config::record::kSupplyPressure, "supply pressure", kPressurePlot, 1e6},
    {"in", config::record::kPressureIn, "chamber that extends", kPressurePlot, 1e6},
    {"out", config::record::kPressureOut, "chamber that retracts", kPressurePlot, 1e6},
}};

/// A record has those besides time, command and position.
std::string record_column(LiveColumn column) {
  return column < kFirstRod ? kTexts.at(column).column
                            : config::record::rod_column(column - kFirstRod);
}

config::units::PrintedScale scale_of(LiveColumn column) {
  return config::units::printed_scale(record_column(column),
                                      kTexts.at(column < kFirstRod ? column : kPosition).size);
}

}  // namespace

std::string key_of(LiveColumn column) {
  return column < kFirstRod ? kTexts.at(column).key
                            : "rod_" + std::to_string(column - kFirstRod + 1);
}

std::optional<LiveColumn> column_of(std::string_view key) {
  for (std::size_t i = 0; i < kLiveColumns; ++i) {
    const auto column = static_cast<LiveColumn>(i);
    if (key_of(column) == key) return column;
  }
  return std::nullopt;
}

std::string words_of(LiveColumn column) {
  return column < kFirstRod
             ? config::units::axis_words(kTexts.at(column).words)
             : config::units::axis_words("rod") + " " + std::to_string(column - kFirstRod + 1);
}

const char* plot_of(LiveColumn column) {
  return column < kFirstRod ? kTexts.at(column).plot : kMotionPlot;
}

std::string shown_unit(LiveColumn column) {
  return config::units::typeset(" " + scale_of(column).unit).substr(1);
}

double shown_value(const LivePoint& point, LiveColumn column) {
  return point.values.at(column) / scale_of(column).in_si;
}

std::string columns_json(const std::vector<LivePoint>& points, double t0_s,
                         const LiveChoice& choice) {
  std::vector<double> values;
  values.reserve(points.size());
  for (const LivePoint& point : points) values.push_back(point.t_s - t0_s);
  std::string json = fmt::format("\"t0\":{:.6f},\"t\":", t0_s) + present::json_numbers(values);
  for (const LiveColumn column : choice) {
    values.clear();
    const double in_si = scale_of(column).in_si;
    for (const LivePoint& point : points) values.push_back(point.values.at(column) / in_si);
    json += ",\"" + key_of(column) + "\":" + present::json_numbers(values);
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
  std::vector<std::vector<double>> columns(capture.choice.size());
  std::vector<const std::vector<double>*> all;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (const LivePoint& point : capture.points) {
      columns[i].push_back(point.values.at(capture.choice[i]));
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
         columns_json(drawn, capture.span.at_s, capture.choice) + "}";
}

config::record::Record record_of(const Capture& capture) {
  config::record::Record record;
  std::vector<std::pair<LiveColumn, std::vector<double>>> further;
  for (const LiveColumn column : capture.choice) {
    // An error is that of the model which was open, not of the stand.
    if (column != kPosition && column != kCommand && column != kModelError) {
      further.push_back({column, {}});
    }
  }
  std::int64_t last_tick = -1;
  for (const LivePoint& point : capture.points) {
    const double u_V = point.values[kCommand];
    const double y_m = point.values[kPosition];
    if (point.tick < 0 || !std::isfinite(y_m) || !std::isfinite(u_V)) continue;
    if (last_tick >= 0 && point.tick != last_tick + 1) record.gaps.push_back(record.t_s.size());
    last_tick = point.tick;
    record.sample_time_s = point.sample_time_s;
    record.t_s.push_back(static_cast<double>(point.tick) * point.sample_time_s);
    record.u_V.push_back(u_V);
    record.y_m.push_back(y_m);
    for (auto& [column, values] : further) values.push_back(point.values.at(column));
  }
  if (record.t_s.empty()) throw config::schema::UsageError("the capture has no usable sample");
  for (auto& [column, values] : further) {
    record.further.emplace_back(record_column(column), std::move(values));
  }
  return record;
}

}  // namespace workbench::serve
