#include "estimator/greybox/motion_scale.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "estimator/greybox/kinematics.h"
#include "estimator/linear_algebra/decompositions.h"

namespace estimator::greybox {
namespace {

/// Share of the motion that must follow the model's before its size says anything.
constexpr double kFollows = 0.8;
/// Models are off by less than this factor.
constexpr double kModel = 3.0;
constexpr double kThousand = 1000.0;
/// Rods may be calibrated a little beyond the stated stroke.
constexpr double kSpare = 1.2;

}  // namespace

MotionRatio motion_ratio(const Dataset& record, const std::vector<double>& error_m,
                         double observer_per_s, PlantStart start) {
  const auto n = static_cast<Eigen::Index>(record.size());
  Eigen::MatrixXd modelled = Eigen::MatrixXd::Zero(n, 2);
  Eigen::VectorXd measured = Eigen::VectorXd::Zero(n);
  for (const SampleRange& span : segments(record)) {
    double by_model = 0.0;
    double by_one = 0.0;
    double by_rod = 0.0;
    for (std::size_t k = span.begin; k < span.end; ++k) {
      if (record.valid[k] != 0) {
        const auto row = static_cast<Eigen::Index>(k);
        modelled.row(row) << by_model, by_one;
        measured(row) = by_rod;
      }
      if (k + 1 == span.end) break;
      const double kept = 1.0 - record.observer_gain(k, observer_per_s, start).position;
      const double step_m = record.y_m[k + 1] - record.y_m[k];
      by_model = kept * by_model + step_m - (error_m[k + 1] - kept * error_m[k]);
      by_one = kept * by_one + record.sample_time_s;
      by_rod = kept * by_rod + step_m;
    }
  }
  const double all = measured.squaredNorm();
  if (!(all > 0.0) || !(modelled.col(0).squaredNorm() > 0.0)) return {};
  const Eigen::VectorXd drift = linear_algebra::pivoted_least_squares(modelled.col(1), measured);
  const double moving = (measured - modelled.col(1) * drift).squaredNorm();
  const Eigen::VectorXd both = linear_algebra::pivoted_least_squares(modelled, measured);
  const double left = (measured - modelled * both).squaredNorm();
  return {both(0), moving > 0.0 ? std::clamp(1.0 - left / moving, 0.0, 1.0) : 0.0};
}

ScaleError scale_error(const MotionRatio& motion) noexcept {
  if (motion.explained < kFollows) return ScaleError::none;
  const auto about = [&](double factor) {
    return motion.ratio > factor / kModel && motion.ratio < factor * kModel;
  };
  if (about(kThousand)) return ScaleError::thousandfold;
  return about(1.0 / kThousand) ? ScaleError::thousandth : ScaleError::none;
}

ValueRange usual_range(std::vector<double> values) {
  constexpr double kLeftOut = 0.01;
  const auto quantile = [&](double share) {
    const auto at =
        values.begin() +
        static_cast<std::ptrdiff_t>(std::round(share * static_cast<double>(values.size() - 1)));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  const double low = quantile(kLeftOut);
  return {low, quantile(1.0 - kLeftOut)};
}

ScaleError scale_error(double low_m, double high_m, double stroke_m) noexcept {
  const double span_m = high_m - low_m;
  constexpr double kFarOutside = 10.0;
  if (span_m > kFarOutside * stroke_m && span_m <= kSpare * kThousand * stroke_m) {
    return ScaleError::thousandfold;
  }
  const bool tiny = low_m >= 0.0 && kThousand * high_m <= kSpare * stroke_m;
  return tiny ? ScaleError::thousandth : ScaleError::none;
}

bool lies_turned(double low_m, double high_m, double stroke_m) noexcept {
  return stroke_m > 0.0 && low_m < 0.0 && high_m <= 0.0 && -low_m <= stroke_m;
}

}  // namespace estimator::greybox
