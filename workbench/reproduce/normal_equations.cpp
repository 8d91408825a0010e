#include "workbench/reproduce/normal_equations.h"

#include <Eigen/LU>

namespace workbench::reproduce {

std::vector<double> solve_normal_equations(const estimator::Structure& structure,
                                           std::span<const double> u_V,
                                           std::span<const double> y_m) {
  const int p = structure.n + structure.m;
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(p, p);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(p);
  Eigen::VectorXd psi(p);
  for (std::size_t t = structure.history(); t < y_m.size(); ++t) {
    for (int i = 0; i < structure.n; ++i) psi[i] = -y_m[t - 1 - i];
    for (int j = 0; j < structure.m; ++j) psi[structure.n + j] = u_V[t - structure.k - j];
    moments += psi * psi.transpose();
    right += psi * y_m[t];
  }
  const Eigen::VectorXd theta = moments.inverse() * right;
  return {theta.data(), theta.data() + theta.size()};
}

}  // namespace workbench::reproduce
