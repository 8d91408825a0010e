#include "estimator/greybox/multistart.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace estimator::greybox {
namespace {

constexpr std::uint64_t kSeed = 20020601;

/// Random numbers independent of the standard library.
class Draw {
 public:
  double uniform() { return (static_cast<double>(engine_() >> 11U) + 0.5) * 0x1p-53; }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(2.0 * M_PI * uniform());
  }

 private:
  std::mt19937_64 engine_{kSeed};
};

double drawn(const FreeParameter& p, double start, Draw& draw) {
  const double z = draw.normal();
  const double sign = draw.uniform() < 0.5 ? -1.0 : 1.0;
  if (std::isfinite(p.prior_sd)) return p.prior_mean + p.prior_sd * z;
  if (p.scale == ParameterScale::logarithmic) return start + 0.5 * z;
  if (start != 0.0) return start * std::exp(0.6 * z);
  const double size = 0.3 * std::exp(z);
  return p.lower < 0.0 ? sign * size : size;
}

}  // namespace

std::vector<Eigen::VectorXd> starting_points(const std::vector<FreeParameter>& parameters,
                                             const Eigen::VectorXd& start, int count) {
  std::vector<Eigen::VectorXd> points{start};
  Draw draw;
  while (static_cast<int>(points.size()) < count) {
    Eigen::VectorXd theta = start;
    for (Eigen::Index j = 0; j < theta.size(); ++j) {
      const FreeParameter& p = parameters[static_cast<std::size_t>(j)];
      theta[j] = std::clamp(drawn(p, start[j], draw), p.lower, p.upper);
    }
    points.push_back(theta);
  }
  return points;
}

}  // namespace estimator::greybox
