// Samples of the running stand as the live page draws them, and those about a trigger's crossing,
// which become a record.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/record/record.h"
#include "config/signals/nan.h"
#include "config/signals/sample.h"
#include "workbench/serve/trigger.h"

namespace workbench::serve {

/// What a stream may have of each sample.
enum LiveColumn : std::size_t {
  kReference,
  kPosition,
  kRequested,
  kCommand,
  kModelError,  ///< of the model beside the stand
  kSupply,
  kPressureIn,
  kPressureOut,
  kFirstRod,
  kLiveColumns = kFirstRod + config::signals::kMaxRods
};

/// SI; a missing value is NaN.
using LiveValues = std::array<double, kLiveColumns>;

constexpr LiveValues nothing_measured() {
  LiveValues none{};
  none.fill(config::signals::kNaN);
  return none;
}

/// One sample; in a gap all values are missing.
struct LivePoint {
  double t_s = 0.0;  ///< since 1970
  LiveValues values = nothing_measured();
  std::int64_t tick = -1;  ///< of the loop's grid; below 0: a gap
  double sample_time_s = 0.0;
};

/// Columns that a stream has.
using LiveChoice = std::vector<LiveColumn>;

/// "reference", "y", "u", "u_requested", "error", "supply", "in", "out", "rod_1".
[[nodiscard]] std::string key_of(LiveColumn column);
[[nodiscard]] std::optional<LiveColumn> column_of(std::string_view key);
/// "measured", "supply pressure".
[[nodiscard]] std::string words_of(LiveColumn column);
/// Columns of one plot share the axis: "position", "command", "model error", "pressure".
[[nodiscard]] const char* plot_of(LiveColumn column);
/// The unit in which the column is shown, of the axis that the thread prints.
[[nodiscard]] std::string shown_unit(LiveColumn column);
/// In that unit.
[[nodiscard]] double shown_value(const LivePoint& point, LiveColumn column);

/// Members of a JSON object: "t0" in s since 1970, then "t" after it and the chosen columns by
/// their keys, as shown.
[[nodiscard]] std::string columns_json(const std::vector<LivePoint>& points, double t0_s,
                                       const LiveChoice& choice);

/// The samples about a crossing, at the full rate.
struct Capture {
  std::uint64_t number = 0;  ///< from 1
  TriggerSettings settings;
  Trigger::Span span{};
  std::vector<LivePoint> points;
  LiveChoice choice;
  double lacks_s = 0.0;  ///< of its beginning, for which no sample was kept
};

/// How much of the span lies before the first point, where that is more than one period.
[[nodiscard]] double lacking_s(const Capture& capture);

/// For the page: as columns_json(), times after the crossing, thinned so that no peak is lost.
[[nodiscard]] std::string to_json(const Capture& capture);
/// As `spoolwatch record` would have recorded it: time on the loop's grid, a gap where there is
/// one. Throws config::schema::UsageError where nothing usable was captured.
[[nodiscard]] config::record::Record record_of(const Capture& capture);

}  // namespace workbench::serve
