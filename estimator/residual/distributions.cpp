#include "estimator/residual/distributions.h"

#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "config/signals/nan.h"

namespace estimator::residual {
namespace {

using config::signals::kNaN;

namespace math = boost::math;
using math::policies::ignore_error;
/// NaN or infinity instead of an exception.
constexpr math::policies::policy<math::policies::domain_error<ignore_error>,
                                 math::policies::overflow_error<ignore_error>,
                                 math::policies::evaluation_error<ignore_error>>
    kPolicy;

}  // namespace

double chi_square_upper(double x, double dof) {
  if (std::isnan(x) || std::isnan(dof)) return kNaN;
  if (!(x > 0.0)) return 1.0;
  if (std::isinf(x)) return 0.0;
  return math::gamma_q(dof / 2.0, x / 2.0, kPolicy);
}

double student_two_sided(double t, double dof) {
  if (std::isnan(t)) return t;
  return math::ibeta(dof / 2.0, 0.5, dof / (dof + t * t), kPolicy);
}

double chi_square_quantile_upper(double p, double dof) {
  return 2.0 * math::gamma_q_inv(dof / 2.0, p, kPolicy);
}

double f_quantile_upper(double p, double dof1, double dof2) {
  double above = 0.0;  // 1 - below, without cancellation
  const double below = math::ibeta_inv(dof2 / 2.0, dof1 / 2.0, p, &above, kPolicy);
  return dof2 * above / (dof1 * below);
}

double beta_quantile(double p, double a, double b) { return math::ibeta_inv(a, b, p, kPolicy); }

}  // namespace estimator::residual
