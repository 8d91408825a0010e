#include "estimator/greybox/tracking/measured_parameter.h"

#include <algorithm>
#include <cmath>

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;

/// Least standard error of a reading, as a ratio to the reading.
constexpr double kLeastOfReading = 1e-4;

/// The matrix with one more row and column at `at`, and `diagonal` where they meet.
Eigen::MatrixXd widened(const Eigen::MatrixXd& matrix, Index at, double diagonal) {
  const Index n = matrix.rows();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n + 1, n + 1);
  const auto place = [at](Index i) { return i < at ? i : i + 1; };
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) out(place(i), place(j)) = matrix(i, j);
  }
  out(at, at) = diagonal;
  return out;
}

}  // namespace

MeasuredMean measured_mean(const double* values, std::size_t samples) {
  const Eigen::Map<const Eigen::ArrayXd> read(values, static_cast<Index>(samples));
  const double mean = read.mean();
  const auto count = static_cast<double>(samples);
  return {mean, std::max(std::sqrt((read - mean).square().sum() / (count * (count - 1.0))),
                         kLeastOfReading * mean)};
}

WindowFitSummary with_held(WindowFitSummary found, std::size_t held, double std_error) {
  const auto at = static_cast<Index>(held);
  found.covariance = widened(found.covariance, at, std_error * std_error);
  found.correlation = widened(found.correlation, at, 1.0);
  found.likeness = widened(found.likeness, at, 1.0);
  found.at_bound.insert(found.at_bound.begin() + static_cast<std::ptrdiff_t>(held), 0);
  const Eigen::VectorXd fitted = found.std_error;
  found.std_error.resize(fitted.size() + 1);
  found.std_error << fitted.head(at), std_error, fitted.tail(fitted.size() - at);
  return found;
}

}  // namespace estimator::greybox::tracking
