#include "estimator/linear_algebra/decompositions.h"

#include <Eigen/QR>

namespace estimator::linear_algebra {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd upper_triangle(const MatrixXd& a) {
  const Eigen::HouseholderQR<MatrixXd> qr(a);
  return qr.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>();
}

PivotedRotation pivoted_rotation(const MatrixXd& a, const VectorXd& b, double threshold) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr(a);
  qr.setThreshold(threshold);
  return {qr.householderQ().transpose() * b, qr.rank()};
}

MatrixXd orthonormal_basis(const MatrixXd& a, double threshold) {
  Eigen::ColPivHouseholderQR<MatrixXd> qr(a);
  qr.setThreshold(threshold);
  return qr.householderQ() * MatrixXd::Identity(a.rows(), qr.rank());
}

VectorXd pivoted_least_squares(const MatrixXd& a, const VectorXd& b) {
  return a.colPivHouseholderQr().solve(b);
}

ShortestSolution shortest_least_squares(const MatrixXd& a, const VectorXd& b) {
  const Eigen::CompleteOrthogonalDecomposition<MatrixXd> qr(a);
  return {qr.solve(b), qr.rank()};
}

MatrixXd shortest_least_squares(const MatrixXd& a, const MatrixXd& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> qr;
  qr.setThreshold(threshold);
  qr.compute(a);
  return qr.solve(b);
}

MatrixXd pseudo_inverse(const MatrixXd& a) {
  return a.completeOrthogonalDecomposition().pseudoInverse();
}

}  // namespace estimator::linear_algebra
