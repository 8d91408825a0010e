// Motions that repeat, and the scatter of a residual between their repetitions: what no model
// driven by the command can explain, without any assumption about the disturbance.
//
//   e(p + k P) = d(p) + n(p + k P)     phase p of P samples, repetition k
//
//   scatter^2 = sum_p sum_k (e - mean_k e)^2 / sum_p (N_p - 1)        n: sensor and disturbance
//   repeating^2 = mean_p ((mean_k e)^2 - scatter^2 / N_p)             d: follows from the motion
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>

namespace estimator::residual {

/// Period of a position, samples: the shortest shift by which it agrees with itself to a fiftieth
/// of what a shift can do at most; none where fewer than two repetitions fit in.
[[nodiscard]] std::optional<std::size_t> repetition_period(
    const Eigen::Ref<const Eigen::VectorXd>& y_m);

/// Sums of squares, to be added up over records.
struct RepetitionScatter {
  double scatter_sum = 0.0;  ///< m^2
  double scatter_freedom = 0.0;
  double repeating_sum = 0.0;  ///< m^2
  double phases = 0.0;

  RepetitionScatter& operator+=(const RepetitionScatter& other);
  /// RMS of what differs between repetitions, m; NaN where no phase comes twice.
  [[nodiscard]] double scatter_m() const;
  /// RMS of what repeats, m; 0 where it is lost in the scatter.
  [[nodiscard]] double repeating_m() const;
};

/// `weights`: 1 for samples that count, 0 for others; as long as the residual.
[[nodiscard]] RepetitionScatter repetition_scatter(
    const Eigen::Ref<const Eigen::VectorXd>& residual_m,
    const Eigen::Ref<const Eigen::VectorXd>& weights, std::size_t period);

}  // namespace estimator::residual
