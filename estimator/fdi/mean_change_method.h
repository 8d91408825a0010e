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
  void show(std::span<EstimatedValue> values) const noexcept final;
  void forget_verdict() noexcept { verdict_ = {}, out_ = false; }
  void serialize_verdict(StateArchive& archive);

 private:
  std::shared_ptr<const MeanChangeConfig> config_;
  Verdict verdict_;
  bool out_ = false;
  mutable char reason_[160] = "";
};

}  // namespace estimator::fdi
