// A factor of 1000 between a record and a model, as a unit that is read wrongly makes it.
//
//   z(k+1) = (1 - l Ts) z(k) + modelled step,   m likewise of the measured one,   m ~ ratio z + b
//   z_1
//
// The weak observer l takes the drift away; z_1 is the response to a constant speed.
#pragma once

#include <vector>

#include "estimator/greybox/dataset.h"

namespace estimator::greybox {

/// Measured over modelled motion.
struct MotionRatio {
  double ratio = 1.0;
  double explained = 0.0;  ///< share of the measured motion's square that ratio and drift explain
};

enum class ScaleError { none, thousandfold, thousandth };

/// `error_m`: measured less modelled position under the observer, one per sample, of a model that
/// starts as `start` says.
[[nodiscard]] MotionRatio motion_ratio(const Dataset& record, const std::vector<double>& error_m,
                                       double observer_per_s, PlantStart start);

/// Motions that follow the model's, but are about 1000 times as far, or a thousandth.
[[nodiscard]] ScaleError scale_error(const MotionRatio& motion) noexcept;

/// Longer than any cylinder's stroke or axis's travel on a test stand.
inline constexpr double kLongest_m = 30.0;

struct ValueRange {
  double low, high;
};
/// Least and greatest but for the outermost hundredth at either end: dropouts and outliers are no
/// motion. Requires values.
[[nodiscard]] ValueRange usual_range(std::vector<double> values);

/// Positions far outside a stroke that fit into it when divided by 1000; positions from 0 on within
/// a thousandth of it.
[[nodiscard]] ScaleError scale_error(double low_m, double high_m, double stroke_m) noexcept;

/// Positions outside a stroke that lie within it with the other sign.
[[nodiscard]] bool lies_turned(double low_m, double high_m, double stroke_m) noexcept;

}  // namespace estimator::greybox
