#include "estimator/structures/linear.h"

#include <algorithm>
#include <cmath>

#include "estimator/linear_algebra/decompositions.h"

namespace estimator::structures {

using Eigen::Index;
using Eigen::VectorXd;

Rows regression_rows(const Orders& o, const Stretches& data,
                     const std::vector<std::vector<double>>& errors) {
  const int columns = o.a + o.b + o.c + (o.constant ? 1 : 0);
  const auto first_of = [&](std::size_t s) {
    int first = std::max(o.a, o.b > 0 ? o.k + o.b - 1 : 0);
    if (o.c == 0) return first;
    int known = 0;
    while (known < data[s].size() && std::isnan(errors[s][known])) ++known;
    return std::max(first, known + o.c);
  };
  Index count = 0;
  for (std::size_t s = 0; s < data.size(); ++s) count += std::max(0, data[s].size() - first_of(s));
  Rows out{Eigen::MatrixXd(count, columns), VectorXd(count)};
  Index row = 0;
  for (std::size_t s = 0; s < data.size(); ++s) {
    const Stretch& stretch = data[s];
    for (int t = first_of(s); t < stretch.size(); ++t, ++row) {
      Index column = 0;
      const auto at = static_cast<std::size_t>(t);
      for (int i = 1; i <= o.a; ++i) out.psi(row, column++) = -stretch.y_m[at - i];
      for (int i = 0; i < o.b; ++i) out.psi(row, column++) = stretch.u_V[at - o.k - i];
      for (int i = 1; i <= o.c; ++i) out.psi(row, column++) = errors[s][at - i];
      if (o.constant) out.psi(row, column) = 1.0;
      out.target[row] = stretch.y_m[at];
    }
  }
  return out;
}

VectorXd solve_rows(const Rows& rows) {
  VectorXd length = rows.psi.colwise().norm().transpose();
  for (double& value : length) value = value > 0.0 ? value : 1.0;
  const Eigen::MatrixXd scaled = rows.psi * length.cwiseInverse().asDiagonal();
  return linear_algebra::shortest_least_squares(scaled, rows.target).x.cwiseQuotient(length);
}

Polynomial fit_arx(const Orders& orders, const Stretches& data) {
  Orders arx = orders;
  arx.c = arx.d = arx.f = 0;
  const VectorXd theta = solve_rows(regression_rows(arx, data));
  return from_values(arx, theta.data());
}

}  // namespace estimator::structures
