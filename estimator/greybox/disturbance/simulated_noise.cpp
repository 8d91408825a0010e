#include "estimator/greybox/disturbance/simulated_noise.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "estimator/greybox/disturbance/model_ensemble.h"
#include "estimator/greybox/observer_correction.h"
#include "estimator/greybox/observer_simulation.h"

namespace estimator::greybox::disturbance {

using plant_sim::Ensemble;

double simulated_disturbance_rms_m(const plant_sim::ModelFile& model, const Dataset& record,
                                   const std::vector<FreeParameter>& parameters,
                                   const Eigen::VectorXd& theta, const NoiseParameters& noise,
                                   double force_place) {
  constexpr std::size_t kPlain = 0;
  const std::unique_ptr<Ensemble> ensemble =
      model_ensemble(model, record.sample_time_s, parameters, theta);
  ensemble->place_disturbance(force_place);
  const bool forces = ensemble->find("load_force.force_N").has_value();
  const ObserverCorrection observer(*ensemble, record, kObserver_per_s);
  const double keeps = std::exp(-2.0 * std::numbers::pi * noise.corner_Hz * record.sample_time_s);
  const double fresh = noise.disturbance_sd * std::sqrt(1.0 - keeps * keeps);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  Ensemble::Values force{};
  for (std::size_t i = 1; i < force.size(); ++i) force[i] = noise.disturbance_sd * normal(random);
  double squares_m2 = 0.0;
  double counted = 0.0;
  std::size_t segment = 0;
  for (std::size_t k = 0; k < record.size(); ++k) {
    if (segment < record.starts.size() && record.starts[segment] == k) {
      ensemble->start(record.y_m[k]);
      ++segment;
    }
    const Ensemble::Values reading_m = ensemble->reading_m();
    Ensemble::Values error_m;
    for (std::size_t i = 0; i < error_m.size(); ++i) error_m[i] = record.y_m[k] - reading_m[i];
    for (std::size_t i = 1; i < error_m.size() && record.valid[k] != 0; ++i) {
      squares_m2 += std::pow(reading_m[i] - reading_m[kPlain], 2);
      counted += 1.0;
    }
    observer.apply(*ensemble, k, error_m);
    for (std::size_t i = 1; i < force.size(); ++i) {
      force[i] = keeps * force[i] + fresh * normal(random);
    }
    if (forces) {
      ensemble->disturb(force);
    } else {
      Ensemble::Values moved{};
      for (std::size_t i = 1; i < moved.size(); ++i) moved[i] = force[i] * record.sample_time_s;
      ensemble->shift(moved);
    }
    Ensemble::Values u_V;
    u_V.fill(record.u_V[k]);
    ensemble->advance(u_V, record.sample_time_s);
  }
  return std::sqrt(squares_m2 / std::max(counted, 1.0));
}

}  // namespace estimator::greybox::disturbance
