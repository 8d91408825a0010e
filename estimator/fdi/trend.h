// [[trend]], experimental: slow drift of a value, beside the fast alarms: level, slope, and the
// time until a limit is reached at that slope. The scorecard counts 8 false alarms in 12 h.
//
// Local linear trend (integrated random walk) by Kalman's filter over block means x:
//
//   level' = level + h slope,  slope' = slope + w,  x = level + e
//   var e = std_dev^2,  cov w = q [h^3/3 h^2/2; h^2/2 h],  q = std_dev^2 h / memory_s^4
//
// h: time between two blocks. The gain forgets over about memory_s (P. C. Young, Recursive
// Estimation and Time-Series Analysis, 1984, ch. 8). A block more than 4 standard deviations from
// its prediction counts as 4 deviations away (Huber): one outlier, or a fast fault that is detected
// otherwise, does not disturb the trend; after 10 such blocks in a row the filter restarts at the
// new level. The alarm is raised when the slope is significant (3.5 standard errors) and a limit is
// nearer than horizon_s; time_to_limit_s is infinite while the value does not move towards a limit.
// Source: A. C. Harvey, Forecasting, Structural Time Series Models and the Kalman Filter, 1989.
#pragma once

#include "estimator/fdi/trained.h"

namespace estimator::fdi {

/// Values: level, slope_per_s, time_to_limit_s.
struct TrendConfig final : TrainedMethodConfig {
  std::string quantity;
  double std_dev = kNaN;
  double memory_s = 3600.0;
  double horizon_s = 86400.0;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::string parameter;
  bool falls_with_parameter = false;
  AlarmNaming naming;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] std::vector<std::string> quantities() const override { return {quantity}; }
  void adopt(const TrainedMethod& trained) override { std_dev = trained.healthy()->long_run[0]; }
  [[nodiscard]] const char* list() const override { return "trend"; }
  [[nodiscard]] std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
  [[nodiscard]] std::unique_ptr<DetectionMethodConfig> clone() const override {
    return std::make_unique<TrendConfig>(*this);
  }
};

/// The Kalman filter alone. Steps may differ in length.
class LocalTrend {
 public:
  LocalTrend(double std_dev, double q) : variance_(std_dev * std_dev), q_(q) {}
  /// `step`: time since the previous value.
  void add(double value, double step) noexcept;
  [[nodiscard]] double level() const noexcept { return level_; }
  [[nodiscard]] double slope() const noexcept { return slope_; }
  [[nodiscard]] double level_error() const noexcept;
  [[nodiscard]] double slope_error() const noexcept;
  [[nodiscard]] int seen() const noexcept { return seen_; }

 private:
  static constexpr double kHuber = 4.0;
  static constexpr int kNewLevel = 10;
  void start(double value) noexcept;

  double variance_, q_;
  double level_ = 0.0, slope_ = 0.0;
  double p11_ = 0.0, p12_ = 0.0, p22_ = 0.0;
  int seen_ = 0;     ///< values, up to 1000
  int far_off_ = 0;  ///< consecutive blocks far off
};

}  // namespace estimator::fdi
