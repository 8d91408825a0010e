// One estimator of the pipeline: pre-processing, engine, and the checks on its window.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "estimator/estimate.h"
#include "estimator/fdi/engine.h"
#include "estimator/fdi/window_monitor.h"
#include "estimator/preprocess.h"
#include "estimator/state_archive.h"

namespace estimator::fdi {

class Stage {
 public:
  /// Throws schema::ConfigError naming [[estimator]] and the id.
  Stage(const EstimatorConfig& config, double sample_time_s);

  /// `periods` samples missing before the next one; true when an estimate became due meanwhile.
  bool lose(std::int64_t periods) noexcept;
  /// A sample; NaN in u or y is a missing one. True when an estimate is due.
  bool push(double u_V, double y_m, bool saturated) noexcept;
  void reset();
  void serialize(StateArchive& archive);

  /// Of the window that became due last; its reason covers gaps, saturation and excitation too.
  [[nodiscard]] Estimate estimate() const noexcept;
  /// Within warmup_s, or before the first window was full.
  [[nodiscard]] bool warming_up() const noexcept;
  [[nodiscard]] const Structure& structure() const noexcept { return structure_; }

 private:
  [[nodiscard]] bool feed(double u_V, double y_m, bool saturated) noexcept;

  EstimatorConfig config_;
  Structure structure_;
  Preprocess preprocess_;
  Preprocess fresh_;  ///< as at the start
  std::unique_ptr<Engine> engine_;
  WindowMonitor monitor_;
  std::int64_t warmup_samples_;
  std::int64_t samples_ = 0;  ///< periods since the start, missing ones included
  double previous_y_m_;       ///< NaN when there is none
  bool saturated_ = false;    ///< any of the samples that one decimated sample stands for
};

}  // namespace estimator::fdi
