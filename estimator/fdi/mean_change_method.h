// Common part of the tests for a change of mean, [[cusum]] and [[glr]], on one value of another
// method, or of the sample, standardised by its healthy distribution:
//
//   z = (block mean - mean) / std_dev,     std_dev of block means over long runs
//
// The threshold follows from a stated mean time between false alarms (average_run_length.h). The
// mean is only known to std_dev / sqrt(blocks): the threshold assumes an error of 1.645 times that
// (95 %, one side).
#pragma once

#include "estimator/fdi/block_method.h"
#include "estimator/fdi/trained.h"

namespace estimator::fdi {

struct MeanChangeConfig : TrainedMethodConfig {
  std::string quantity;
  double false_alarm_time_s = 86400.0;
  double mean = kNaN;
  double std_dev = kNaN;
  double mean_error = 0.0;  ///< standard error of `mean`, in its unit
  std::string parameter;
  bool falls_with_parameter = false;
  std::vector<std::string> ambiguity_group;
  AlarmNaming naming;

  [[nodiscard]] std::vector<std::string> quantities() const override { return {quantity}; }
  void adopt(const TrainedMethod& trained) override;

 protected:
  void visit_change(config::schema::Visitor& v);
};

/// Values: statistic (1 at the threshold), shift (of the mean since the detected change, in the
/// quantity's unit), since_s (time since the change).
class MeanChangeMethod : public BlockMethod {
 public:
  /// Throws schema::ConfigError when the configuration is not trained.
  MeanChangeMethod(const MeanChangeConfig& config, const MethodContext& context);

  [[nodiscard]] std::vector<std::string> names() const final {
    return {"statistic", "shift", "since_s"};
  }
  [[nodiscard]] std::vector<Alarm> declared_alarms() const final;
  [[nodiscard]] AlarmInput alarm_input(std::size_t number) const noexcept final;

 protected:
  /// State of the test after the newest standardised block.
  struct Verdict {
    double statistic = 0.0;  ///< 1 at the threshold
    double shift = 0.0;      ///< mean of z since the change, std_dev
    double blocks = 0.0;     ///< since the change
  };
  [[nodiscard]] virtual Verdict test(double z) noexcept = 0;
  /// Required number of blocks between false alarms.
  [[nodiscard]] double run_length() const noexcept;
  /// 95 % limit of the error of the mean, in std_dev.
  [[nodiscard]] double mean_error() const noexcept;

  void take(std::span<const double> means) noexcept final;
  void show(std::span<NamedValue> values) const noexcept final;
  void forget_verdict() noexcept { verdict_ = {}, out_ = false; }
  void serialize_verdict(StateArchive& archive);

 private:
  std::shared_ptr<const MeanChangeConfig> config_;
  Verdict verdict_;
  bool out_ = false;
  mutable char reason_[160] = "";
};

/// [[cusum]]: the cumulative sum test, for a shift of the mean of known size.
///
///   S+ = max(0, S+ + z - k),  S- = max(0, S- - z - k),  alarm when either reaches h
///
/// z: standardised block mean (mean_change_method.h); k = shift_sigma/2 is optimal for a shift of
/// shift_sigma; h follows from the mean time between false alarms. The sums saturate at 1.25 h so
/// that an alarm returns soon after its cause; it returns at h/2. The shift is the mean of z since
/// the sum was last zero, which is also the estimate of the time of change. Source: E. S. Page,
/// Biometrika 41 (1954) 100; D. C. Montgomery, Statistical Quality Control, 9.1.
struct CusumConfig final : MeanChangeConfig {
  double shift_sigma = 1.0;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] const char* list() const override { return "cusum"; }
  [[nodiscard]] std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
  [[nodiscard]] std::unique_ptr<DetectionMethodConfig> clone() const override {
    return std::make_unique<CusumConfig>(*this);
  }
};

/// [[glr]]: the generalised likelihood ratio test, for a shift of the mean of unknown size.
///
///   G = max over n = 1..window_blocks of |z(t) + ... + z(t-n+1)| / sqrt(n),  alarm when G >= b
///
/// z: standardised block mean (mean_change_method.h). The maximising n estimates the time of
/// change, the mean of those n its size. A large change is detected within one block, a small one
/// within at most window_blocks. Source: M. Basseville, I. V. Nikiforov, Detection of Abrupt
/// Changes, 1993, 2.4.3; window: T. L. Lai, Journal of the Royal Statistical Society B 57 (1995)
/// 613.
struct GlrConfig final : MeanChangeConfig {
  std::int64_t window_blocks = 64;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] const char* list() const override { return "glr"; }
  [[nodiscard]] std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
  [[nodiscard]] std::unique_ptr<DetectionMethodConfig> clone() const override {
    return std::make_unique<GlrConfig>(*this);
  }
};

}  // namespace estimator::fdi
