// Design of a short motion that determines the tracked parameters best: sines within given limits
// are simulated in closed loop with the healthy error as noise, and each is fitted like a window.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "plant_sim/model_file.h"

namespace estimator::greybox::tracking {

struct ExcitationLimits {
  double low_m = 0.0;
  double high_m = 0.0;      ///< not above low_m: no probe is suggested
  double speed_mps = 0.05;  ///< upper limit
  double command_V = 10.0;  ///< upper limit

  [[nodiscard]] bool given() const { return high_m > low_m; }
};

struct ExcitationDesign {
  double centre_m = 0.0;
  double amplitude_m = 0.0;
  double frequency_Hz = 0.0;
  double duration_s = 0.0;
  Eigen::VectorXd std_error;  ///< tracked parameters, search units
};

/// Standard errors of the tracked parameters for given samples of command and position.
using Foresee = std::function<Eigen::VectorXd(const double* u_V, const double* y_m)>;

/// None where no sine within the limits determines every parameter. `samples`: lead-in and window.
[[nodiscard]] std::optional<ExcitationDesign> design_excitation(
    const plant_sim::ModelFile& baseline, const ExcitationLimits& limits, std::size_t samples,
    double sample_time_s, double noise_m, const Foresee& foresee);

}  // namespace estimator::greybox::tracking
