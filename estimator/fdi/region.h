// Where the block means of some values lie when all is well, or under one fault: a mean and a
// covariance learned from n blocks, and how far a new block is from it.
//
//   T^2 = (x - mean)' S^-1 (x - mean)
//   P(T^2 > limit) = p,  limit = d (n + 1)(n - 1) / (n (n - d)) F(p; d, n - d)
//
// d: number of values. The F law has the uncertainty of mean and S in it; for large n it becomes
// chi-square with d degrees of freedom. It holds for normal block means that do not depend on each
// other. Which value the distance comes from: what is left of T^2 when the others are known,
// c_i = (S^-1 (x - mean))_i^2 / (S^-1)_ii.
// Source: H. Hotelling 1931; N. D. Tracy, J. C. Young, R. L. Mason, Journal of Quality Technology
// 24 (1992) 88 (F law of a new observation); the same authors, ibid. 27 (1995) 99 (c_i).
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace estimator::fdi {

class Region {
 public:
  /// `covariance` row by row. Throws schema::ConfigError at `where` when it is not positive
  /// definite or `blocks` are too few for the dimension.
  Region(std::span<const double> mean, std::span<const double> covariance, double blocks,
         const std::string& where);

  /// T^2; no allocation.
  [[nodiscard]] double distance2(std::span<const double> x) noexcept;
  /// Of the last x: number of the value with the greatest c_i.
  [[nodiscard]] std::size_t most() const noexcept { return most_; }
  /// T^2 that a new block exceeds with probability p.
  [[nodiscard]] double limit(double p) const;
  /// Log density of the last x under a normal law, but for a constant that depends on d alone.
  [[nodiscard]] double log_density() const noexcept { return -0.5 * (distance2_ + log_det_); }
  [[nodiscard]] std::size_t size() const noexcept { return static_cast<std::size_t>(mean_.size()); }

 private:
  Eigen::VectorXd mean_, scale_, x_, solved_;
  Eigen::MatrixXd inverse_;  ///< of the correlation matrix
  double log_det_ = 0.0;
  double blocks_;
  double distance2_ = 0.0;
  std::size_t most_ = 0;
};

}  // namespace estimator::fdi
