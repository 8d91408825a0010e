// Profile likelihood of one unknown: how the least cost rises as it is held away from its best
// value, all others free.
//
//   rise(v) = (min over the others of cost(x_j = v) - cost(solution)) / inflation;
//   the 95 % interval is where rise < 3.84 (chi-square, one degree of freedom)
//
// Honest where the cost is not quadratic: near bounds, for widths and dead zones, along curved
// valleys. sqrt(rise) is nearly straight, so a few points find each end.
// Source: G. A. F. Seber, C. J. Wild, Nonlinear Regression, 5.4; A. Raue et al., Bioinformatics 25
// (2009) 1923.
#pragma once

#include <vector>

#include "estimator/nonlinear/minimize.h"

namespace estimator::nonlinear {

/// 95 % quantile of chi-squared with one degree of freedom: rise of the cost at the ends of an
/// interval.
inline constexpr double kProfile95 = 3.841458820694124;

struct ProfileOptions {
  double threshold = kProfile95;
  double inflation = 1.0;    ///< Covariance::inflation of the unknown: sigma wrong, or colour
  double first_step = 0.0;   ///< initial step, e.g. two standard errors; 0: from the Jacobian
  int max_points = 12;       ///< to each side
  MinimizeOptions minimize;  ///< options for the other unknowns
};

struct ProfilePoint {
  double value = 0.0;
  double rise = 0.0;
};

struct Profile {
  std::vector<ProfilePoint> points;  ///< in order of value, the solution among them with rise 0
  double low = 0.0;                  ///< the bound (or the last value tried) where not found
  double high = 0.0;
  bool low_found = false;
  bool high_found = false;
  bool cancelled = false;
  int evaluations = 0;  ///< groups
  /// The least cost met and its place: below the solution's when the fit had stopped short.
  double least_cost = 0.0;
  Eigen::VectorXd least_x;
};

[[nodiscard]] Profile profile(const Problem& problem, const Solution& solution,
                              Eigen::Index unknown, const ProfileOptions& options = {});

}  // namespace estimator::nonlinear
