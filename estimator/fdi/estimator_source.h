// An [[estimator]] as a source: its coefficients, residual_rms_m and condition.
#pragma once

#include "estimator/fdi/quantity.h"
#include "estimator/fdi/source.h"
#include "estimator/fdi/stage.h"

namespace estimator::fdi {

class EstimatorSource final : public Source {
 public:
  /// Throws schema::ConfigError naming [[estimator]] and the id.
  EstimatorSource(const EstimatorConfig& config, double sample_time_s)
      : stage_(config, sample_time_s),
        interval_s_(config.method == "batch" ? config.window_s : config.stride_s) {}

  [[nodiscard]] std::vector<std::string> names() const override {
    return estimate_names(stage_.structure());
  }
  bool lose(std::int64_t periods) noexcept override { return stage_.lose(periods); }
  bool push(const config::signals::Sample& sample, double y_m) noexcept override {
    return stage_.push(sample.u_applied_V, y_m, sample.saturated);
  }
  Finding find(std::span<NamedValue> values) noexcept override;
  void reset() override { stage_.reset(); }
  void serialize(StateArchive& archive) override { stage_.serialize(archive); }
  [[nodiscard]] double interval_s() const noexcept override { return interval_s_; }

 private:
  Stage stage_;
  double interval_s_;
};

}  // namespace estimator::fdi
