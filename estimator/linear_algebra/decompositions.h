// Dense decompositions of matrices of any size, compiled once: each costs the compiler seconds in
// every source that names Eigen's own. A vector has functions of its own beside a matrix of one
// column, because Eigen sums the two in different orders.
#pragma once

#include <Eigen/Core>

namespace estimator::linear_algebra {

/// Greatest first.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& a);
Eigen::VectorXd singular_values(const Eigen::MatrixXcd& a);

struct SingularVectors {
  Eigen::VectorXd values;   ///< greatest first
  Eigen::MatrixXd vectors;  ///< columns, as many as there are values
};
SingularVectors left_singular_vectors(const Eigen::MatrixXd& a);
SingularVectors right_singular_vectors(const Eigen::MatrixXd& a);

/// R of a = Q R; no fewer rows than columns.
Eigen::MatrixXd upper_triangle(const Eigen::MatrixXd& a);

/// Q' of a P = Q R: pivots over `threshold` of the greatest count for the rank.
struct PivotedRotation {
  Eigen::VectorXd rotated;  ///< Q' b; the first `rank` entries lie in the columns of `a`
  Eigen::Index rank = 0;
};
PivotedRotation pivoted_rotation(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                 double threshold);
/// The first columns of Q, as many as the rank.
Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& a, double threshold);
/// argmin |a x - b| by pivoted QR.
Eigen::VectorXd pivoted_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// The shortest of argmin |a x - b|, and the rank of `a`.
struct ShortestSolution {
  Eigen::VectorXd x;
  Eigen::Index rank = 0;
};
ShortestSolution shortest_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
/// One column of x per column of `b`; pivots above `threshold` times the greatest count for the
/// rank.
Eigen::MatrixXd shortest_least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                       double threshold);
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& a);

/// a x = b for a regular `a`: by LU, and by LDL' where `a` is symmetric and positive definite.
Eigen::MatrixXd solve(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& a);

}  // namespace estimator::linear_algebra
