// [[distance]]: distance of several values, taken together, from their healthy region. Detects a
// combination that never occurred, which no band on one value can.
//
//   T^2 = (x - mean)' S^-1 (x - mean)
//   P(T^2 > limit) = p,  limit = d (n + 1)(n - 1) / (n (n - d)) F(p; d, n - d)
//
// mean, S: mean and covariance of n block means, healthy or under one fault; d: number of values.
// The F distribution includes the uncertainty of mean and S; for large n the limit becomes
// chi-square with d degrees of freedom. Assumes normal, independent block means. Contribution of
// one value: its share of T^2 when the others are known, c_i = (S^-1 (x - mean))_i^2 / (S^-1)_ii.
//
// Each block is one decision: the probability that a healthy block is outside is block length over
// mean time between false alarms. The alarm names the value that contributes most.
// Source: H. Hotelling 1931; N. D. Tracy, J. C. Young, R. L. Mason, Journal of Quality Technology
// 24 (1992) 88 (F distribution of a new observation); the same authors, ibid. 27 (1995) 99 (c_i).
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "estimator/fdi/trained.h"

namespace estimator::fdi {

class HotellingT2 {
 public:
  /// `covariance` row by row. Throws schema::ConfigError at `where` when the covariance is not
  /// positive definite or `blocks` are too few for the dimension.
  HotellingT2(std::span<const double> mean, std::span<const double> covariance, double blocks,
              const std::string& where);

  /// T^2; no allocation.
  [[nodiscard]] double statistic(std::span<const double> x) noexcept;
  /// Number of the value with the greatest c_i, for the last x.
  [[nodiscard]] std::size_t main_contributor() const noexcept { return main_contributor_; }
  /// T^2 that a new block exceeds with probability p.
  [[nodiscard]] double limit(double p) const;
  /// Log density of the last x under the normal distribution, up to a constant that depends on d
  /// alone.
  [[nodiscard]] double log_density() const noexcept { return -0.5 * (t2_ + log_det_); }

 private:
  Eigen::VectorXd mean_, scale_, x_, solved_;
  Eigen::MatrixXd inverse_;  ///< inverse of the correlation matrix
  double log_det_ = 0.0;
  double blocks_;
  double t2_ = 0.0;
  std::size_t main_contributor_ = 0;
};

/// Values: distance2 (T^2), limit.
struct HotellingT2Config final : TrainedMethodConfig {
  std::vector<std::string> features;  ///< "sliding.a1", "sliding.b1", ...
  double false_alarm_time_s = 86400.0;
  TrainedClass healthy;
  AlarmNaming naming;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] std::vector<std::string> quantities() const override { return features; }
  void adopt(const TrainedMethod& trained) override { healthy = *trained.healthy(); }
  [[nodiscard]] const char* list() const override { return "distance"; }
  [[nodiscard]] std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
  [[nodiscard]] std::unique_ptr<DetectionMethodConfig> clone() const override {
    return std::make_unique<HotellingT2Config>(*this);
  }
};

}  // namespace estimator::fdi
