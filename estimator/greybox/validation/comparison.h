// Comparison of a model with a record: size of the error relative to the sensor's noise floor, and
// the regions in which it arises.
//
//   e(k)      measured less modelled position, the model driven by the measured command. An
//   observer
//             on the position corrects the drift of an integrating plant
//             (greybox/observer_simulation.h).
//   free run  simulation from each segment's first sample without correction
//   fit       100 (1 - |e| / |y - mean y|), free run
//
// Speed error of a step: (e(k+1) - (1 - l Ts) e(k)) / Ts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimator/greybox/command_response.h"
#include "estimator/greybox/dataset.h"
#include "estimator/greybox/kinematics.h"
#include "estimator/greybox/motion_scale.h"
#include "estimator/greybox/observer_simulation.h"
#include "estimator/greybox/validation/k_step.h"
#include "estimator/greybox/validation/regions.h"
#include "estimator/greybox/validation/significant_regions.h"
#include "estimator/greybox/validation/systematic_error.h"
#include "estimator/spectra/resonance.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::validation {

/// Range of the command over the samples.
struct CommandRange {
  enum class Limitation { none, often_limited, always_limited, constant };

  Limitation limitation = Limitation::none;
  double most_V = 0.0;         ///< greatest magnitude; for a constant command its value
  double limited_share = 0.0;  ///< share of the samples at the greatest magnitude
};

/// Positions outside the model's stroke.
struct StrokeExcess {
  double low_m = 0.0;
  double high_m = 0.0;
  double stroke_m = 0.0;
};

struct Comparison {
  std::string model;
  Dataset record;
  Kinematics kinematics;
  double observer_per_s = 0.0;

  // One number per sample.
  std::vector<double> error_m;       ///< drift-corrected, unsettled samples included
  std::vector<double> free_error_m;  ///< free run
  std::vector<double> speed_error_mps;
  /// Speed error, mean over +-50 ms, less the share that a gain and an offset explain; the regions
  /// are found in this.
  std::vector<double> local_velocity_error_mps;

  double rms_m = 0.0;           ///< drift-corrected, settled samples
  double free_run_rms_m = 0.0;  ///< all samples
  double fit_percent = 0.0;
  double noise_floor_m = 0.0;  ///< NaN: unknown (a record below 20 Hz)
  double encoder_step_m = 0.0;
  std::vector<KStep> k_step;    ///< 1, 10, 100 samples
  double whiteness_p = 1.0;     ///< whiteness of e
  double independence_p = 1.0;  ///< independence of e from past commands

  std::vector<Region> regions;
  std::vector<SignificantRegion> worst;  ///< by one variable each, most significant first
  SignificantRegion headline;            ///< most significant, by one variable or two
  SystematicError systematic;
  MotionRatio motion;
  CommandResponse response;
  CommandRange command;
  double stroke_m = 0.0;  ///< the model's; 0: it has none
  std::optional<StrokeExcess> beyond_stroke;
  /// Resonance of the measured response that the model's lacks (speed_response.h).
  std::optional<spectra::Resonance> resonance;

  [[nodiscard]] double floor_ratio() const { return rms_m / noise_floor_m; }
  [[nodiscard]] double duration_s() const;
};

/// The errors of a model alone, as a Comparison has them.
struct ModelErrors {
  PlantStart start = PlantStart::held_by_oil;  ///< the model's
  std::vector<double> error_m;
  std::vector<double> free_error_m;
  double rms_m = 0.0;
  double free_run_rms_m = 0.0;
  double fit_percent = 0.0;
};

/// Two simulations and nothing more: for a model that is being changed by hand. Throws
/// config::schema::ConfigError for a model that cannot be built.
[[nodiscard]] ModelErrors errors_of(const plant_sim::ModelFile& model, const Dataset& record,
                                    double observer_per_s = kObserver_per_s);

/// Error, in noise floors, up to which it counts as noise.
inline constexpr double kAtFloor = 1.15;

/// Observer gain in 1/s: above 0 and below 1 / sample time. Throws config::schema::DataError for a
/// record without motion, ConfigError for a model that cannot be built.
[[nodiscard]] Comparison compare(const plant_sim::ModelFile& model, const Dataset& record,
                                 double observer_per_s = kObserver_per_s);

}  // namespace estimator::greybox::validation
