#include "estimator/residual/whiteness.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "config/signals/nan.h"
#include "estimator/linear_algebra/decompositions.h"
#include "estimator/residual/autoregression.h"
#include "estimator/residual/distributions.h"

namespace estimator::residual {
namespace {

using config::signals::kNaN;

/// Mean of the input over samples t - last .. t - first, NaN when one is missing.
class PastMeans {
 public:
  explicit PastMeans(std::span<const double> input) : sum_(input.size() + 1), bad_(sum_.size()) {
    for (std::size_t t = 0; t < input.size(); ++t) {
      const bool missing = std::isnan(input[t]);
      sum_[t + 1] = sum_[t] + (missing ? 0.0 : input[t]);
      bad_[t + 1] = bad_[t] + (missing ? 1 : 0);
    }
  }
  [[nodiscard]] double at(std::size_t t, std::size_t first, std::size_t last) const {
    if (t < last) return kNaN;
    const std::size_t from = t - last;
    const std::size_t to = t - first + 1;
    if (bad_[to] != bad_[from]) return kNaN;
    return (sum_[to] - sum_[from]) / static_cast<double>(to - from);
  }

 private:
  std::vector<double> sum_;
  std::vector<int> bad_;
};

}  // namespace

TestResult whiteness(std::span<const double> residual, int lags, int fitted) {
  TestResult out;
  std::vector<double> centred(residual.begin(), residual.end());
  double mean = 0.0;
  for (const double value : centred) {
    if (std::isnan(value)) continue;
    mean += value;
    ++out.samples;
  }
  out.dof = lags - fitted;
  if (out.samples < 5 * lags || out.dof < 1) {
    out.p = kNaN;
    return out;
  }
  mean /= out.samples;
  for (double& value : centred) value -= mean;
  const std::vector<double> gamma = autocovariance(centred, lags);
  if (!(gamma[0] > 0.0)) return out;
  const double n = out.samples;
  for (int k = 1; k <= lags; ++k) {
    // The pairs that exist: n - k, fewer across gaps.
    int pairs = 0;
    for (std::size_t t = static_cast<std::size_t>(k); t < centred.size(); ++t) {
      pairs += !std::isnan(centred[t]) && !std::isnan(centred[t - static_cast<std::size_t>(k)]);
    }
    // gamma is averaged over pairs, Ljung and Box's over n: rho n / pairs, variance 1 / pairs.
    const double rho = gamma[static_cast<std::size_t>(k)] / gamma[0];
    out.statistic += pairs * rho * rho * (n + 2.0) / n;
    if (std::abs(rho) > std::abs(out.worst_correlation)) {
      out.worst_correlation = rho;
      out.worst_lag = k;
    }
  }
  out.p = chi_square_upper(out.statistic, out.dof);
  return out;
}

TestResult independence(std::span<const double> residual, std::span<const double> input,
                        int reach) {
  assert(residual.size() == input.size());
  TestResult out;
  const std::vector<double> w = whiten(residual, fit_autoregression(residual));
  struct Window {
    std::size_t first, last;
  };
  std::vector<Window> windows{{1, 1}};
  for (std::size_t last = 2; last <= static_cast<std::size_t>(std::max(1, reach)); last *= 2) {
    windows.push_back({last / 2 + 1, last});
  }
  const auto columns = static_cast<Eigen::Index>(windows.size());
  const PastMeans means(input);
  std::vector<double> rows;
  std::vector<double> right;
  for (std::size_t t = windows.back().last; t < w.size(); ++t) {
    if (std::isnan(w[t])) continue;
    const std::size_t begin = rows.size();
    bool whole = true;
    for (const Window& window : windows) {
      rows.push_back(means.at(t, window.first, window.last));
      whole = whole && !std::isnan(rows.back());
    }
    if (whole) {
      right.push_back(w[t]);
    } else {
      rows.resize(begin);
    }
  }
  const auto n = static_cast<Eigen::Index>(right.size());
  out.samples = static_cast<int>(n);
  if (n < 10 * columns) {
    out.p = kNaN;
    return out;
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::MatrixXd A = Eigen::Map<const RowMajor>(rows.data(), n, columns);
  Eigen::VectorXd b = Eigen::Map<const Eigen::VectorXd>(right.data(), n);
  A.rowwise() -= A.colwise().mean().eval();
  b.array() -= b.mean();
  for (Eigen::Index j = 0; j < columns; ++j) {
    const double norm = A.col(j).norm();
    if (!(norm > 0.0) || !(b.norm() > 0.0)) continue;
    A.col(j) /= norm;
    const double correlation = A.col(j).dot(b) / b.norm();
    if (std::abs(correlation) > std::abs(out.worst_correlation)) {
      out.worst_correlation = correlation;
      out.worst_lag = static_cast<int>(windows[static_cast<std::size_t>(j)].last);
    }
  }
  // A sine has two dimensions only, whatever the number of windows.
  const auto [rotated, rank] = linear_algebra::pivoted_rotation(A, b, 1e-6);
  if (rank == 0) return out;
  const double explained = rotated.head(rank).squaredNorm();
  const double left = rotated.tail(n - rank).squaredNorm();
  out.dof = static_cast<double>(rank);
  out.statistic = left > 0.0 ? explained / left * static_cast<double>(n - rank - 1) : 0.0;
  out.p = chi_square_upper(out.statistic, out.dof);
  return out;
}

}  // namespace estimator::residual
