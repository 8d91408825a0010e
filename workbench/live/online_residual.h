// A model beside the running rig: simulated with the measured command sample by sample, drift taken
// away as `compare` does (greybox/observer_simulation.h), and once a second what its error is over
// the last seconds, beside what the sensor lets any model reach, and where it arises.
//
//   fit    100 (1 - |e| / |y - mean y|) over the same seconds, e the drift-corrected error
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "estimator/greybox/observer_simulation.h"
#include "plant_sim/ensemble.h"
#include "plant_sim/model_file.h"
#include "workbench/compare/region_spans.h"

namespace workbench::live {

namespace greybox = estimator::greybox;

/// Figures of the residual; a number that is not known yet is NaN.
struct ResidualFigures {
  double t_s = 0.0;       ///< time of the newest sample
  double window_s = 0.0;  ///< settled samples behind rms_m
  double rms_m = 0.0;
  double fit_percent = 0.0;
  double noise_floor_m = 0.0;
  double floor_ratio = 0.0;                 ///< rms_m / noise_floor_m
  std::string worst;                        ///< in words, "" where none stands out
  std::string worst_variable;               ///< "v", "u", "y", ...
  double worst_from = 0.0, worst_to = 0.0;  ///< SI
  double worst_rms_m = 0.0;
  std::vector<compare::TimeSpan> worst_spans;  ///< when the samples were in it, as t_s
  std::string note;                            ///< why a figure is missing
};

class OnlineResidual {
 public:
  /// Spans of error and fit, and of the search for a region.
  static constexpr double kShort_s = 10.0;
  static constexpr double kLong_s = 30.0;

  explicit OnlineResidual(const plant_sim::ModelFile& model,
                          double observer_per_s = greybox::kObserver_per_s);

  /// One usable sample. A tick that does not follow the one before begins a new segment. Throws
  /// config::schema::Error for a model that cannot be built at this sample time.
  void add(std::int64_t tick, double sample_time_s, double u_V, double y_m);
  [[nodiscard]] bool empty() const noexcept { return samples_.empty(); }
  /// Of the newest sample, drift-corrected; NaN while the model settles.
  [[nodiscard]] double newest_error_m() const { return samples_.back().error_m; }
  [[nodiscard]] ResidualFigures figures() const;

 private:
  struct Sample {
    std::int64_t tick;
    double u_V, y_m, error_m;  ///< error NaN while it settles
    bool starts;               ///< a segment
  };
  void find_worst(ResidualFigures& figures) const;

  plant_sim::ModelFile model_;
  double observer_per_s_;
  double sample_time_s_ = 0.0;
  std::unique_ptr<plant_sim::Ensemble> ensemble_;
  std::deque<Sample> samples_;
  std::int64_t in_segment_ = 0;  ///< samples so far
};

/// "12 s  rms 24.1 um  fit 99.2 %  4.1 x floor  worst ...".
[[nodiscard]] std::string line_of(const ResidualFigures& figures);
/// One JSON object, SI, a missing number null.
[[nodiscard]] std::string json_of(const ResidualFigures& figures);

}  // namespace workbench::live
