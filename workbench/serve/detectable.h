// The smallest change of a watched quantity that an alarm would show now: from its estimate to the
// edge of its band, and two standard errors more, so that an estimate that errs by as much still
// leaves the band.
//
//   down = (value - low + 2 s) / |value|,  up = (high - value + 2 s) / |value|
#pragma once

namespace workbench::serve {

struct DetectableChange {
  double down_ratio, up_ratio;  ///< NaN: nothing is detected on this side
};

/// `std_error` NaN: not known, taken as 0. A value outside its band on one side is detected there
/// already: 0.
[[nodiscard]] DetectableChange detectable_change(double value, double std_error, double low,
                                                 double high);

}  // namespace workbench::serve
