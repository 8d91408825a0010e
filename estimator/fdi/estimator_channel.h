// [[estimator]]: preprocessing, an estimation method, and the checks on its window. Values: the
// coefficients, residual_rms_m, condition.
#pragma once

#include <cstdint>
#include <memory>

#include "estimator/estimate.h"
#include "estimator/fdi/detection_method.h"
#include "estimator/fdi/estimation_method.h"
#include "estimator/fdi/window_monitor.h"
#include "estimator/preprocess.h"

namespace estimator::fdi {

class EstimatorChannel final : public DetectionMethod {
 public:
  /// Throws schema::ConfigError naming [[estimator]] and the id.
  EstimatorChannel(const EstimatorConfig& config, double sample_time_s);

  [[nodiscard]] std::vector<std::string> names() const override {
    return estimate_names(structure_);
  }
  bool on_gap(std::int64_t periods) noexcept override;
  bool push(const config::signals::Sample& sample, double y_m) noexcept override;
  MethodOutput evaluate(std::span<EstimatedValue> values) noexcept override;
  void reset() override;
  void serialize(StateArchive& archive) override;
  [[nodiscard]] double interval_s() const noexcept override {
    return config_.method == "batch" ? config_.window_s : config_.stride_s;
  }

 private:
  [[nodiscard]] bool feed(double u_V, double y_m, bool saturated) noexcept;
  /// Estimate of the window that became due last; its reason covers gaps, saturation and
  /// excitation.
  [[nodiscard]] Estimate estimate() const noexcept;
  /// Within warmup_s, or before the first window was full.
  [[nodiscard]] bool warming_up() const noexcept;

  EstimatorConfig config_;
  Structure structure_;
  Preprocess preprocess_;
  Preprocess initial_preprocess_;
  std::unique_ptr<EstimationMethod> method_;
  WindowMonitor monitor_;
  std::int64_t warmup_samples_;
  std::int64_t window_samples_;
  std::int64_t samples_ = 0;    ///< since the present motion began
  double previous_y_m_ = kNaN;  ///< NaN when there is none
  bool saturated_ = false;      ///< any sample behind the decimated one was saturated
};

}  // namespace estimator::fdi
