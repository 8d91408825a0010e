#include "estimator/greybox/disturbance/linearisation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "estimator/greybox/disturbance/model_ensemble.h"
#include "estimator/greybox/observer_correction.h"
#include "estimator/greybox/observer_simulation.h"
#include "plant_sim/library.h"

namespace estimator::greybox::disturbance {
namespace {

using plant_sim::Ensemble;

struct Perturbed {
  const char* name;
  double size;
};
/// Large enough for differences to rise above rounding, small enough to stay linear.
constexpr std::array kPerturbed = {Perturbed{"y_m", 1e-6}, Perturbed{"v_mps", 1e-5},
                                   Perturbed{"pressure_in_Pa", 1e3},
                                   Perturbed{"pressure_out_Pa", 1e3}};
constexpr double kForce_N = 1.0;
constexpr double kSupply_Pa = 1e3;
/// Lane 0 is the model itself; the quotients start from lane 1, which has no friction and no play.
constexpr std::size_t kOwn = 0;
constexpr std::size_t kSmooth = 1;

/// All parameters of the effects that make the step of a model jump, with their neutral values.
/// None may stay: without its Coulomb level, the rise towards standstill would be a negative
/// damping.
std::vector<std::pair<std::size_t, double>> ragged_parameters(const Ensemble& ensemble,
                                                              const plant_sim::ModelFile& model) {
  std::vector<std::pair<std::size_t, double>> found;
  for (const plant_sim::EffectInfo& effect : plant_sim::effects_of(model)) {
    const auto acts_at = [&](const char* site) {
      return std::find(effect.sites.begin(), effect.sites.end(), site) != effect.sites.end();
    };
    if (!acts_at("dry_friction") && !acts_at("sensor")) continue;
    for (const plant_sim::ParameterInfo& parameter : effect.parameters) {
      const auto index = ensemble.find(effect.name + "." + parameter.name);
      if (index) found.emplace_back(*index, parameter.neutral);
    }
  }
  return found;
}

double width_of_play_m(const Ensemble& ensemble) {
  const auto width = ensemble.find(kPlayWidth);
  return width ? ensemble.get(*width, kOwn) : 0.0;
}

/// Distances of the rod from passing its motion on through a play, as the record's innovations
/// predict them: a simulation goes astray by more than a play.
std::vector<double> gaps_m(const plant_sim::ModelFile& model, const Dataset& record,
                           const std::vector<FreeParameter>& parameters,
                           const Eigen::VectorXd& theta, double width_m) {
  ObserverSimulation run(model, record, parameters);
  Eigen::MatrixXd residuals_m;
  run.residuals(theta, residuals_m);
  const ObserverSimulation::Predicted& at = run.predicted();
  std::vector<double> result(record.size());
  double reading_m = at.reading_m.front();
  for (std::size_t k = 0; k < record.size(); ++k) {
    const double ahead_m = reading_m - at.rod_m[k];  // before the rod takes the sensor along
    result[k] = 0.5 * width_m - std::abs(ahead_m);
    reading_m = at.reading_m[k] + at.correction_m[k];
  }
  return result;
}

}  // namespace

PlantStart start_of(const std::vector<std::string>& states) {
  const auto has = [&](const char* name) {
    return std::find(states.begin(), states.end(), name) != states.end();
  };
  return has("v_mps") && !has("pressure_in_Pa") ? PlantStart::any_speed : PlantStart::held_by_oil;
}

Linearisation linearise(const plant_sim::ModelFile& model, const Dataset& record,
                        const std::vector<FreeParameter>& parameters,
                        const Eigen::VectorXd& theta) {
  const std::unique_ptr<Ensemble> ensemble =
      model_ensemble(model, record.sample_time_s, parameters, theta);
  for (const auto& [index, neutral] : ragged_parameters(*ensemble, model)) {
    for (std::size_t lane = kSmooth; lane < Ensemble::kLanes; ++lane) {
      ensemble->set(index, lane, neutral);
    }
  }
  Linearisation result;
  std::vector<std::size_t> states;
  std::vector<double> sizes;
  for (const Perturbed& state : kPerturbed) {
    const auto index = ensemble->find_state(state.name);
    if (!index) continue;
    result.states.emplace_back(state.name);
    states.push_back(*index);
    sizes.push_back(state.size);
  }
  const std::size_t count = states.size();
  const std::size_t force_lane = kSmooth + count + 1;
  const std::size_t supply_lane = force_lane + 1;
  if (ensemble->find("load_force.force_N")) {
    result.force = true;
    Ensemble::Values force_N{};
    force_N[force_lane] = kForce_N;
    ensemble->disturb(force_N);
  }
  if (const auto supply = ensemble->find("supply_pressure_Pa")) {
    result.supply = true;
    ensemble->set(*supply, supply_lane, ensemble->get(*supply, supply_lane) + kSupply_Pa);
  }
  std::vector<std::size_t> every;  // all states that a lane must share with the model before a step
  for (const char* name : {"y_m", "v_mps", "pressure_in_Pa", "pressure_out_Pa", "spool_m",
                           "spool_mps", "drive_mps", "drive_mps2"}) {
    if (const auto index = ensemble->find_state(name)) every.push_back(*index);
  }
  const std::size_t samples = record.size();
  result.transition.assign(samples, StateMatrix::Zero());
  result.from_supply.assign(samples, StateVector::Zero());
  result.speed_mps.resize(samples);
  const ObserverCorrection observer(*ensemble, record, kObserver_per_s);
  std::size_t segment = 0;
  for (std::size_t k = 0; k < samples; ++k) {
    if (segment < record.starts.size() && record.starts[segment] == k) {
      ensemble->start(record.y_m[k]);
      ++segment;
    }
    result.speed_mps[k] = ensemble->speed_mps()[kOwn];
    Ensemble::Values error_m{};
    error_m[kOwn] = record.y_m[k] - ensemble->reading_m()[kOwn];
    observer.apply(*ensemble, k, error_m);
    for (const std::size_t state : every) {
      Ensemble::Values values = ensemble->state(state);
      values.fill(values[kOwn]);
      for (std::size_t i = 0; i < count; ++i) {
        if (states[i] == state) values[kSmooth + 1 + i] += sizes[i];
      }
      ensemble->set_state(state, values);
    }
    Ensemble::Values u_V;
    u_V.fill(record.u_V[k]);
    ensemble->advance(u_V, record.sample_time_s);
    for (std::size_t i = 0; i < count; ++i) {
      const Ensemble::Values after = ensemble->state(states[i]);
      const auto row = static_cast<Eigen::Index>(i);
      for (std::size_t j = 0; j < count; ++j) {
        result.transition[k](row, static_cast<Eigen::Index>(j)) =
            (after[kSmooth + 1 + j] - after[kSmooth]) / sizes[j];
      }
      if (result.force) {
        result.transition[k](row, kMostStates - 1) =
            (after[force_lane] - after[kSmooth]) / kForce_N;
      }
      if (result.supply) {
        result.from_supply[k][row] = (after[supply_lane] - after[kSmooth]) / kSupply_Pa;
      }
    }
    if (!result.force) result.transition[k](0, kMostStates - 1) = record.sample_time_s;
  }
  const double play_m = width_of_play_m(*ensemble);
  if (play_m > 0.0 && record.innovations) {
    result.gap_m = gaps_m(model, record, parameters, theta, play_m);
  }
  return result;
}

bool has_play(const plant_sim::ModelFile& model, const std::vector<FreeParameter>& parameters,
              const Eigen::VectorXd& theta) {
  return width_of_play_m(*model_ensemble(model, model.step_s, parameters, theta)) > 0.0;
}

}  // namespace estimator::greybox::disturbance
