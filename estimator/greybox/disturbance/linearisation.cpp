#include "estimator/greybox/disturbance/linearisation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "estimator/greybox/disturbance/model_ensemble.h"
#include "estimator/greybox/observer_correction.h"
#include "estimator/greybox/observer_simulation.h"
#include "estimator/greybox/sensor_place.h"
#include "plant_sim/library.h"

namespace estimator::greybox::disturbance {
namespace {

using plant_sim::Ensemble;

struct Perturbed {
  const char* name;
  double size;
};
/// Large enough for differences to rise above rounding, small enough to stay linear.
constexpr std::array kPerturbed = {Perturbed{"y_m", 1e-6},
                                   Perturbed{"v_mps", 1e-5},
                                   Perturbed{"pressure_in_Pa", 1e3},
                                   Perturbed{"pressure_out_Pa", 1e3},
                                   Perturbed{kSecondMassOffset, 1e-6},
                                   Perturbed{kSecondMassOffsetSpeed, 1e-5}};
constexpr double kForce_N = 1.0;
constexpr double kSupply_Pa = 1e3;
/// Lane 0 is the model itself; the quotients start from lane 1, which has no friction and no play.
constexpr std::size_t kOwn = 0;
constexpr std::size_t kSmooth = 1;
constexpr std::size_t kQuotients = Ensemble::kLanes - kSmooth - 1;  ///< lanes of one ensemble

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
    if (acts_at("coupling") || (!acts_at("dry_friction") && !acts_at("sensor"))) continue;
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

/// Difference quotients of a plant's step along its own trajectory, kQuotients in an ensemble: one
/// per state, then those of the force and of the supply pressure.
class Quotients {
 public:
  Quotients(const plant_sim::ModelFile& model, const Dataset& record,
            const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& theta,
            double force_place)
      : record_(record) {
    ensembles_.push_back(model_ensemble(model, record.sample_time_s, parameters, theta));
    const bool coupled = has_second_mass(own(), kOwn);
    for (const Perturbed& state : kPerturbed) {
      const auto index = own().find_state(state.name);
      const bool offset = std::string_view(state.name).starts_with("second_mass.");
      if (!index || (offset && !coupled)) continue;
      names_.emplace_back(state.name);
      states_.push_back(*index);
      sizes_.push_back(state.size);
    }
    if (coupled) offset_ = own().find_state(kSecondMassOffset);
    place_ = sensor_place(own())[kOwn];
    for (const char* name :
         {"y_m", "v_mps", "pressure_in_Pa", "pressure_out_Pa", "spool_m", "spool_mps", "drive_mps",
          "drive_mps2", kSecondMassOffset, kSecondMassOffsetSpeed}) {
      if (const auto index = own().find_state(name)) shared_.push_back(*index);
    }
    force_ = own().find("load_force.force_N").has_value();
    supply_ = own().find("supply_pressure_Pa");
    while (ensembles_.size() * kQuotients < states_.size() + (force_ ? 1 : 0) + (supply_ ? 1 : 0)) {
      ensembles_.push_back(model_ensemble(model, record.sample_time_s, parameters, theta));
    }
    for (const std::unique_ptr<Ensemble>& ensemble : ensembles_) {
      for (const auto& [index, neutral] : ragged_parameters(*ensemble, model)) {
        for (std::size_t lane = kSmooth; lane < Ensemble::kLanes; ++lane) {
          ensemble->set(index, lane, neutral);
        }
      }
      ensemble->place_disturbance(force_place);
      corrections_.emplace_back(*ensemble, record, kObserver_per_s);
    }
    if (force_) {
      Ensemble::Values force_N{};
      force_N[lane_of(states_.size())] = kForce_N;
      ensemble_of(states_.size()).disturb(force_N);
    }
    if (supply_) {
      Ensemble& ensemble = ensemble_of(of_supply());
      const std::size_t lane = lane_of(of_supply());
      ensemble.set(*supply_, lane, ensemble.get(*supply_, lane) + kSupply_Pa);
    }
    after_.resize(states_.size());
  }

  [[nodiscard]] const std::vector<std::string>& states() const { return names_; }
  [[nodiscard]] bool has_force() const { return force_; }
  [[nodiscard]] bool has_supply() const { return supply_.has_value(); }
  [[nodiscard]] double play_m() const { return width_of_play_m(*ensembles_.front()); }
  [[nodiscard]] double speed_mps() const { return ensembles_.front()->speed_mps()[kOwn]; }

  void start(double reading_m) {
    for (const std::unique_ptr<Ensemble>& ensemble : ensembles_) ensemble->start(reading_m);
  }

  /// The step from sample k, of which the state entries are set.
  void advance(std::size_t k, StateMatrix& transition, StateVector& from_supply) {
    Ensemble::Values u_V;
    u_V.fill(record_.u_V[k]);
    for (std::size_t e = 0; e < ensembles_.size(); ++e) {
      Ensemble& ensemble = *ensembles_[e];
      Ensemble::Values error_m{};
      error_m[kOwn] = record_.y_m[k] - ensemble.reading_m()[kOwn];
      corrections_[e].apply(ensemble, k, error_m);
      perturb(e);
      ensemble.advance(u_V, record_.sample_time_s);
      for (std::size_t i = 0; i < states_.size(); ++i) after_[i] = ensemble.state(states_[i]);
      if (offset_) {
        const Ensemble::Values offset_m = ensemble.state(*offset_);
        for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) {
          after_.front()[lane] += place_ * offset_m[lane];
        }
      }
      const std::size_t last = std::min((e + 1) * kQuotients, of_supply() + (supply_ ? 1 : 0));
      for (std::size_t quotient = e * kQuotients; quotient < last; ++quotient) {
        const std::size_t lane = lane_of(quotient);
        for (std::size_t i = 0; i < states_.size(); ++i) {
          const auto row = static_cast<Eigen::Index>(i);
          const double moved = after_[i][lane] - after_[i][kSmooth];
          if (quotient < states_.size()) {
            transition(row, static_cast<Eigen::Index>(quotient)) = moved / sizes_[quotient];
          } else if (quotient < of_supply()) {
            transition(row, kMostStates - 1) = moved / kForce_N;
          } else {
            from_supply[row] = moved / kSupply_Pa;
          }
        }
      }
    }
  }

 private:
  [[nodiscard]] const Ensemble& own() const { return *ensembles_.front(); }
  [[nodiscard]] std::size_t of_supply() const { return states_.size() + (force_ ? 1 : 0); }
  [[nodiscard]] static std::size_t lane_of(std::size_t quotient) {
    return kSmooth + 1 + quotient % kQuotients;
  }
  [[nodiscard]] Ensemble& ensemble_of(std::size_t quotient) {
    return *ensembles_[quotient / kQuotients];
  }

  /// Sets every lane to the model's own state but for what it perturbs. An offset is moved with the
  /// sensor held.
  void perturb(std::size_t e) {
    Ensemble& ensemble = *ensembles_[e];
    const std::size_t first = e * kQuotients;
    const std::size_t last = std::min(first + kQuotients, states_.size());
    for (const std::size_t state : shared_) {
      Ensemble::Values values = ensemble.state(state);
      values.fill(values[kOwn]);
      for (std::size_t i = first; i < last; ++i) {
        if (states_[i] == state) values[lane_of(i)] += sizes_[i];
        if (state == states_.front() && offset_ && states_[i] == *offset_) {
          values[lane_of(i)] -= place_ * sizes_[i];
        }
      }
      ensemble.set_state(state, values);
    }
  }

  const Dataset& record_;
  std::vector<std::unique_ptr<Ensemble>> ensembles_;
  std::vector<ObserverCorrection> corrections_;
  std::vector<std::string> names_;
  std::vector<std::size_t> states_;
  std::vector<double> sizes_;
  std::vector<std::size_t> shared_;    ///< all that a lane must share with the model before a step
  std::optional<std::size_t> offset_;  ///< second mass's
  double place_ = 0.0;                 ///< sensor_place()
  bool force_ = false;
  std::optional<std::size_t> supply_;  ///< parameter
  std::vector<Ensemble::Values> after_;
};

}  // namespace

PlantStart start_of(const std::vector<std::string>& states) {
  const auto has = [&](const char* name) {
    return std::find(states.begin(), states.end(), name) != states.end();
  };
  return has("v_mps") && !has("pressure_in_Pa") ? PlantStart::any_speed : PlantStart::held_by_oil;
}

Linearisation linearise(const plant_sim::ModelFile& model, const Dataset& record,
                        const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& theta,
                        double force_place) {
  Linearisation result;
  result.force_place = force_place;
  Quotients quotients(model, record, parameters, theta, force_place);
  result.states = quotients.states();
  result.force = quotients.has_force();
  result.supply = quotients.has_supply();
  const std::size_t samples = record.size();
  result.transition.assign(samples, StateMatrix::Zero());
  result.from_supply.assign(samples, StateVector::Zero());
  result.speed_mps.resize(samples);
  std::size_t segment = 0;
  for (std::size_t k = 0; k < samples; ++k) {
    if (segment < record.starts.size() && record.starts[segment] == k) {
      quotients.start(record.y_m[k]);
      ++segment;
    }
    result.speed_mps[k] = quotients.speed_mps();
    quotients.advance(k, result.transition[k], result.from_supply[k]);
    if (!result.force) result.transition[k](0, kMostStates - 1) = record.sample_time_s;
  }
  const double play_m = quotients.play_m();
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
