#include "estimator/greybox/tracking/excitation_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "config/units/quantity.h"
#include "estimator/greybox/observer_simulation.h"
#include "plant_sim/ensemble.h"

namespace estimator::greybox::tracking {
namespace {

using plant_sim::Ensemble;

constexpr double kFrequencies_Hz[] = {0.25, 0.5, 1.0, 2.0, 4.0};
constexpr double kShares[] = {1.0, 0.5};  ///< shares of the greatest amplitude
constexpr double kSwinging_s = 1.0;       ///< lead time before the evaluated window

struct SimulatedMotion {
  std::vector<double> u_V;
  std::vector<double> y_m;
};

/// Closed-loop simulation; empty where the command would exceed its limits.
SimulatedMotion driven(const plant_sim::ModelFile& model, const ExcitationLimits& limits,
                       const ExcitationDesign& probe, std::size_t samples, double sample_time_s,
                       double noise_m) {
  const auto ensemble = plant_sim::make_ensemble(model, step_for(model, sample_time_s));
  ensemble->start(probe.centre_m);
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, noise_m);
  const auto settling = static_cast<std::size_t>(std::ceil(kSwinging_s / sample_time_s));
  SimulatedMotion out;
  for (std::size_t k = 0; k < settling + samples; ++k) {
    const double t_s = static_cast<double>(k) * sample_time_s;
    const double reference_m =
        probe.centre_m +
        probe.amplitude_m * std::sin(2.0 * std::numbers::pi * probe.frequency_Hz * t_s);
    const double y_m = ensemble->reading_m()[0];
    const double u_V = model.loop.kp_V_per_m * (reference_m - y_m);
    if (std::abs(u_V) > limits.command_V || y_m < limits.low_m || y_m > limits.high_m) return {};
    if (k >= settling) {
      out.u_V.push_back(u_V);
      out.y_m.push_back(y_m + noise(random));
    }
    Ensemble::Values every;
    every.fill(u_V);
    ensemble->advance(every, sample_time_s);
  }
  return out;
}

}  // namespace

std::optional<ExcitationDesign> design_excitation(const plant_sim::ModelFile& baseline,
                                                  const ExcitationLimits& limits,
                                                  std::size_t samples, double sample_time_s,
                                                  double noise_m, const Foresee& foresee) {
  std::optional<ExcitationDesign> best;
  double least = INFINITY;
  for (const double frequency_Hz : kFrequencies_Hz) {
    for (const double share : kShares) {
      ExcitationDesign probe;
      probe.centre_m = 0.5 * (limits.low_m + limits.high_m);
      probe.frequency_Hz = frequency_Hz;
      // A tenth of the range is left for overshoot.
      probe.amplitude_m =
          share * std::min(0.45 * (limits.high_m - limits.low_m),
                           0.9 * limits.speed_mps / (2.0 * std::numbers::pi * frequency_Hz));
      probe.duration_s = kSwinging_s + static_cast<double>(samples) * sample_time_s;
      const SimulatedMotion motion =
          driven(baseline, limits, probe, samples, sample_time_s, noise_m);
      if (motion.u_V.empty()) continue;
      probe.std_error = foresee(motion.u_V.data(), motion.y_m.data());
      if (!probe.std_error.allFinite() || !(probe.std_error.maxCoeff() < least)) continue;
      least = probe.std_error.maxCoeff();
      best = probe;
    }
  }
  return best;
}

}  // namespace estimator::greybox::tracking
