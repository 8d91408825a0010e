// Samples of the running stand as the live page draws them, and those about a trigger's crossing,
// which become a record.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/record/record.h"
#include "workbench/serve/trigger.h"

namespace workbench::serve {

/// One sample; a missing value is NaN, and so is all of a gap.
struct LivePoint {
  double t_s;  ///< since 1970
  double reference_m, y_m, u_V;
  double error_m;          ///< of the model beside the stand
  std::int64_t tick = -1;  ///< of the loop's grid; below 0: a gap
  double sample_time_s = 0.0;
};

/// Value of "reference" and "y" in mm, "u" in V, "error" in um; an axis that turns: mrad and urad.
/// NaN for another name.
[[nodiscard]] double shown_value(const LivePoint& point, const std::string& channel);

/// Members of a JSON object: "t0" in s since 1970, then "t" after it and the channels, column by
/// column, as shown.
[[nodiscard]] std::string columns_json(const std::vector<LivePoint>& points, double t0_s);

/// The samples about a crossing, at the full rate.
struct Capture {
  std::uint64_t number = 0;  ///< from 1
  TriggerSettings settings;
  Trigger::Span span{};
  std::vector<LivePoint> points;
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
