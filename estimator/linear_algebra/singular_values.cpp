#include "estimator/linear_algebra/decompositions.h"

#include <Eigen/SVD>

namespace estimator::linear_algebra {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd singular_values(const MatrixXd& a) {
  return Eigen::JacobiSVD<MatrixXd>(a).singularValues();
}

VectorXd singular_values(const MatrixXcd& a) {
  return Eigen::JacobiSVD<MatrixXcd>(a).singularValues();
}

SingularVectors left_singular_vectors(const MatrixXd& a) {
  const Eigen::JacobiSVD<MatrixXd> svd(a, Eigen::ComputeThinU);
  return {svd.singularValues(), svd.matrixU()};
}

SingularVectors right_singular_vectors(const MatrixXd& a) {
  const Eigen::JacobiSVD<MatrixXd> svd(a, Eigen::ComputeThinV);
  return {svd.singularValues(), svd.matrixV()};
}

}  // namespace estimator::linear_algebra
