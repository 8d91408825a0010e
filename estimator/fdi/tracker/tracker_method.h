// Detection method that runs the parameter tracker. Allocates, and one window takes milliseconds:
// belongs on the detector thread, not in the loop.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/fdi/detection_method.h"
#include "estimator/fdi/tracker/tracker_config.h"

namespace estimator::fdi::tracker {

class TrackerMethod final : public estimator::fdi::DetectionMethod {
 public:
  /// `baseline`: none = learned from the first windows that qualify.
  TrackerMethod(const TrackerConfig& config, const plant_sim::ModelFile& model,
                const greybox::tracking::ParameterSet& set,
                std::optional<greybox::tracking::Baseline> baseline, double sample_time_s);

  [[nodiscard]] std::vector<std::string> names() const override;
  [[nodiscard]] std::vector<estimator::fdi::Alarm> declared_alarms() const override;
  bool on_gap(std::int64_t periods) noexcept override;
  bool push(const config::signals::Sample& sample, double y_m) noexcept override;
  estimator::fdi::MethodOutput evaluate(
      std::span<estimator::fdi::EstimatedValue> values) noexcept override;
  [[nodiscard]] estimator::fdi::AlarmInput alarm_input(std::size_t number) const noexcept override;
  void reset() override;
  void serialize(estimator::StateArchive& archive) override;
  [[nodiscard]] double interval_s() const noexcept override { return stride_s_; }

 private:
  /// Alarm of one parameter.
  struct Said {
    std::string reason;
    std::string parameter;
    std::vector<std::string> group;
    std::vector<std::string_view> views;
    estimator::fdi::FaultName fault;
    estimator::fdi::AlarmInput state;
  };

  void take(const greybox::tracking::WindowResult& window);
  void learn_from(const greybox::tracking::WindowResult& window);
  /// Keeps a sample of the healthy rig; a disturbed baseline once there are enough of them.
  void learn_disturbance_from(double u_V, double y_m, bool first);
  [[nodiscard]] bool tells_disturbance() const;
  void tell_disturbance();
  void suggest(const greybox::tracking::WindowResult& window);
  void say();
  void say_slow();
  [[nodiscard]] bool is_due(std::int64_t missing) noexcept;

  double sample_time_s_;
  double stride_s_;
  double window_s_;
  double noise_floor_m_;
  bool pressures_;                   ///< use the pressures of the samples
  std::size_t lessons_;              ///< windows to learn from
  std::size_t disturbance_samples_;  ///< samples to learn a disturbance from; 0: it is not learned
  plant_sim::ModelFile model_;
  estimator::fdi::Severity severity_;
  estimator::fdi::AlarmRules rules_;
  std::optional<greybox::tracking::Baseline> given_;
  greybox::tracking::ParameterTracker tracker_;
  bool broken_ = true;            ///< samples are missing before the next one
  std::int64_t missing_ = 0;      ///< consecutive samples missing since the latest result
  std::vector<double> learning_;  ///< per window: errors, then theta of the parameters
  std::vector<double> found_;     ///< the values, then their standard errors
  std::string why_;
  std::string note_;                  ///< for a valid result: pressures that were left out
  std::optional<std::string> probe_;  ///< suggested motion, once it was computed
  std::vector<double> command_V_;  ///< samples without a gap, from which a disturbance is learned
  std::vector<double> position_m_;
  std::vector<double> disturbance_;  ///< kDisturbanceNames, as measured last
  double rms_m_ = 0.0;
  int samples_ = 0;
  std::int64_t unexplained_ = 0;  ///< consecutive unexplained windows
  std::vector<Said>
      said_;  ///< one per tracked parameter, one per followed parameter, then "unexplained"
};

}  // namespace estimator::fdi::tracker
