#include "estimator/residual/repetition.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace estimator::residual {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Mean squared differences of a repeated motion and of one that has moved away in between, as
/// shares of twice the variance.
constexpr double kSame = 4e-4;
constexpr double kApart = 0.3;
/// Samples compared for each shift, and shifts tried, in a first look.
constexpr Index kCompared = 2000;

/// Mean squared difference at a shift, over at most kCompared pairs.
double difference(const Eigen::Ref<const VectorXd>& y_m, Index shift) {
  const Index pairs = y_m.size() - shift;
  const Index stride = std::max<Index>(1, pairs / kCompared);
  double sum = 0.0;
  Index count = 0;
  for (Index i = 0; i < pairs; i += stride, ++count) {
    const double apart = y_m[i + shift] - y_m[i];
    sum += apart * apart;
  }
  return sum / static_cast<double>(std::max<Index>(1, count));
}

}  // namespace

std::optional<std::size_t> repetition_period(const Eigen::Ref<const VectorXd>& y_m) {
  const Index n = y_m.size();
  const double scale = 2.0 * (y_m.array() - y_m.mean()).square().mean();
  if (n < 8 || !(scale > 0.0)) return {};
  bool apart = false;
  const Index step = std::max<Index>(1, n / (2 * kCompared));
  for (Index shift = step; 2 * shift <= n; shift += step) {
    const double share = difference(y_m, shift) / scale;
    apart = apart || share > kApart;
    if (!apart || share > 100.0 * kSame) continue;
    // the minimum nearby decides
    Index best = shift;
    double least = share;
    for (Index near = shift + 1; 2 * near <= n; ++near) {
      const double other = difference(y_m, near) / scale;
      if (other < least) {
        least = other;
        best = near;
      } else if (near > best + 2 * step) {
        break;
      }
    }
    if (least < kSame) return static_cast<std::size_t>(best);
    shift = std::max(shift, best);
    apart = false;
  }
  return {};
}

RepetitionScatter& RepetitionScatter::operator+=(const RepetitionScatter& other) {
  scatter_sum += other.scatter_sum;
  scatter_freedom += other.scatter_freedom;
  repeating_sum += other.repeating_sum;
  phases += other.phases;
  return *this;
}

double RepetitionScatter::scatter_m() const {
  return scatter_freedom > 0.0 ? std::sqrt(scatter_sum / scatter_freedom)
                               : std::numeric_limits<double>::quiet_NaN();
}

double RepetitionScatter::repeating_m() const {
  return phases > 0.0 ? std::sqrt(std::max(0.0, repeating_sum / phases))
                      : std::numeric_limits<double>::quiet_NaN();
}

RepetitionScatter repetition_scatter(const Eigen::Ref<const VectorXd>& residual_m,
                                     const Eigen::Ref<const VectorXd>& weights,
                                     std::size_t period) {
  RepetitionScatter result;
  const auto step = static_cast<Index>(period);
  struct Phase {
    double count, mean, squares;
  };
  std::vector<Phase> all;
  for (Index phase = 0; phase < step; ++phase) {
    Phase p{0.0, 0.0, 0.0};
    for (Index i = phase; i < residual_m.size(); i += step) {
      if (!(weights[i] > 0.0)) continue;
      p.count += 1.0;
      const double off = residual_m[i] - p.mean;
      p.mean += off / p.count;
      p.squares += off * (residual_m[i] - p.mean);
    }
    if (p.count < 2.0) continue;
    all.push_back(p);
    result.scatter_sum += p.squares;
    result.scatter_freedom += p.count - 1.0;
  }
  const double scatter2 = result.scatter_sum / std::max(1.0, result.scatter_freedom);
  for (const Phase& p : all) {
    result.repeating_sum += p.mean * p.mean - scatter2 / p.count;
    result.phases += 1.0;
  }
  return result;
}

}  // namespace estimator::residual
