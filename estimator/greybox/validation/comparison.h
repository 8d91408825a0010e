// A model held against a record: how large its error is, beside what the sensor lets any model
// reach, and where it arises.
//
//   e(k)    measured less modelled position, the model driven by the measured command. Drift of an
//           integrating plant is taken away by an observer on the position
//           (greybox/observer_simulation.h).
//   free run: the same from each segment's first sample on, nothing corrected.
//   fit     100 (1 - |e| / |y - mean y|), of the free run
//
// Speed error: what the model's speed lacks in each step, (e(k+1) - (1 - l Ts) e(k)) / Ts.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/dataset.h"
#include "estimator/greybox/kinematics.h"
#include "estimator/greybox/observer_simulation.h"
#include "estimator/greybox/validation/k_step.h"
#include "estimator/greybox/validation/regions.h"
#include "estimator/greybox/validation/significant_regions.h"
#include "estimator/greybox/validation/systematic_error.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::validation {

struct Comparison {
  std::string model;
  Dataset record;
  Kinematics kinematics;
  double observer_per_s = 0.0;

  // One number for each sample.
  std::vector<double> error_m;       ///< drift-corrected; the unsettled samples too
  std::vector<double> free_error_m;  ///< of the free run
  std::vector<double> speed_error_mps;
  /// Speed error, a mean over +-50 ms, less what a plain gain and offset explain: by this regions
  /// are told apart.
  std::vector<double> local_velocity_error_mps;

  double rms_m = 0.0;           ///< drift-corrected, settled samples
  double free_run_rms_m = 0.0;  ///< all samples
  double fit_percent = 0.0;
  double noise_floor_m = 0.0;  ///< NaN: unknown (a record below 20 Hz)
  double encoder_step_m = 0.0;
  std::vector<KStep> k_step;    ///< 1, 10, 100 samples
  double whiteness_p = 1.0;     ///< of e: is it noise only?
  double independence_p = 1.0;  ///< of e from past commands
  double limited_share = 0.0;   ///< of the samples: command at its greatest magnitude

  std::vector<Region> regions;
  std::vector<SignificantRegion> worst;  ///< by one variable each, most telling first
  SignificantRegion headline;            ///< the most telling, by one variable or two
  SystematicError systematic;
  std::vector<std::string> notes;  ///< restrictions

  [[nodiscard]] double floor_ratio() const { return rms_m / noise_floor_m; }
  [[nodiscard]] double duration_s() const;
};

/// An error of up to this many noise floors counts as noise.
inline constexpr double kAtFloor = 1.15;

/// Throws config::schema::Error: exit 65 for a record without motion, 78 for a model that cannot be
/// built. Observer gain in 1/s; above 0 and below 1 / sample time.
[[nodiscard]] Comparison compare(const plant_sim::ModelFile& model, const Dataset& record,
                                 double observer_per_s = kObserver_per_s);

}  // namespace estimator::greybox::validation
