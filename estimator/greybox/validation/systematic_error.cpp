#include "estimator/greybox/validation/systematic_error.h"

#include <algorithm>
#include <cmath>

#include "estimator/greybox/kinematics.h"
#include "estimator/linear_algebra/decompositions.h"

namespace estimator::greybox::validation {
namespace {

constexpr double kLeast = 0.5;   ///< least share that is reported
constexpr double kNearly = 1.1;  ///< ratio of the errors left by one number and by two
constexpr double kSlight = 0.01;

/// Share of the squared error that the least-squares fit of `signatures` (columns) removes.
double share(const Eigen::MatrixXd& signatures, const Eigen::VectorXd& e, Eigen::VectorXd& x) {
  x = linear_algebra::pivoted_least_squares(signatures, e);
  const double all = e.squaredNorm();
  return all > 0.0 ? std::clamp(1.0 - (e - signatures * x).squaredNorm() / all, 0.0, 1.0) : 0.0;
}

}  // namespace

SystematicError systematic_error(const Dataset& record, const std::vector<double>& error_m,
                                 const std::vector<double>& speed_error_mps, double observer_per_s,
                                 PlantStart start) {
  const auto n = static_cast<Eigen::Index>(record.size());
  Eigen::MatrixXd signatures = Eigen::MatrixXd::Zero(n, 2);
  Eigen::VectorXd e = Eigen::VectorXd::Zero(n);
  for (const SampleRange& span : segments(record)) {
    double by_speed = 0.0;
    double by_one = 0.0;
    for (std::size_t k = span.begin; k < span.end; ++k) {
      if (record.valid[k] != 0) {
        const auto row = static_cast<Eigen::Index>(k);
        signatures.row(row) << by_speed, by_one;
        e(row) = error_m[k];
      }
      if (k + 1 == span.end) break;
      const double modelled_m =
          record.y_m[k + 1] - record.y_m[k] - speed_error_mps[k] * record.sample_time_s;
      const double kept = 1.0 - record.observer_gain(k, observer_per_s, start).position;
      by_speed = kept * by_speed + modelled_m;
      by_one = kept * by_one + record.sample_time_s;
    }
  }
  Eigen::VectorXd gain;
  Eigen::VectorXd offset;
  Eigen::VectorXd both;
  const double by_gain = share(signatures.col(0), e, gain);
  const double by_offset = share(signatures.col(1), e, offset);
  const double by_both = share(signatures, e, both);
  const double all_m = std::sqrt(
      e.squaredNorm() / std::max<double>(1.0, static_cast<double>(std::count_if(
                                                  record.valid.begin(), record.valid.end(),
                                                  [](char valid) { return valid != 0; }))));
  const auto left_m = [&](double by) { return all_m * std::sqrt(1.0 - by); };
  if (by_both < kLeast) return {ErrorCause::neither, 0.0, 0.0, 0.0, all_m};
  // The explanation with a single number is preferred where two differ little.
  const double nearly = 1.0 - std::max(kNearly * (1.0 - by_both), kSlight);
  if (by_gain >= nearly && by_gain >= by_offset) {
    return {ErrorCause::gain, by_gain, gain(0), 0.0, left_m(by_gain)};
  }
  if (by_offset >= nearly)
    return {ErrorCause::offset, by_offset, 0.0, offset(0), left_m(by_offset)};
  return {ErrorCause::both, by_both, both(0), both(1), left_m(by_both)};
}

}  // namespace estimator::greybox::validation
