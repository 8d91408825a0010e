#include "estimator/greybox/observer_simulation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "config/schema/error.h"
#include "estimator/greybox/observer_correction.h"
#include "estimator/greybox/sensor_place.h"

namespace estimator::greybox {

double step_for(const plant_sim::ModelFile& model, double sample_time_s) {
  return sample_time_s / std::max(1.0, std::ceil(sample_time_s / model.step_s - 1e-6));
}

ObserverSimulation::ObserverSimulation(const plant_sim::ModelFile& model, const Dataset& record,
                                       std::vector<FreeParameter> parameters, double observer_per_s)
    : record_(&record),
      parameters_(std::move(parameters)),
      observer_per_s_(observer_per_s),
      ensemble_(plant_sim::make_ensemble(model, step_for(model, record.sample_time_s))),
      schedule_(model, *ensemble_),
      position_(ensemble_->find_state("y_m").value()),
      speed_mps_(record.size(), 0.0),
      predicted_{std::vector<double>(record.size()), std::vector<double>(record.size()),
                 std::vector<double>(record.size())} {
  for (const FreeParameter& parameter : parameters_) {
    const std::size_t at = std::min(parameter.name.find(kInRecord), parameter.name.size());
    const std::string name = parameter.name.substr(0, at);
    const auto index = ensemble_->find(name);
    const auto number = index ? std::nullopt : schedule_.find(name);
    if (!index && !number) throw config::schema::bad_config(model.name, "has no parameter " + name);
    const bool here =
        name.size() == parameter.name.size() || parameter.name.substr(at + 1) == record.name;
    slots_.push_back({index.value_or(number.value_or(0)), number.has_value(), !here});
  }
}

PlantStart ObserverSimulation::plant_start() const { return greybox::plant_start(*ensemble_); }

void ObserverSimulation::residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m) {
  run(points, {}, {}, residuals_m, nullptr);
}

void ObserverSimulation::residuals(const Eigen::MatrixXd& points, Eigen::MatrixXd& residuals_m,
                                   Chambers& chambers) {
  const auto samples = static_cast<Eigen::Index>(record_->size());
  chambers.in_Pa.resize(samples, kLanes);
  chambers.out_Pa.resize(samples, kLanes);
  run(points, {}, {}, residuals_m, &chambers);
}

void ObserverSimulation::residuals(const Eigen::MatrixXd& points, const Eigen::MatrixXd& added_V,
                                   const Eigen::MatrixXd& added_N, Eigen::MatrixXd& residuals_m) {
  run(points, added_V, added_N, residuals_m, nullptr);
}

void ObserverSimulation::take(const Eigen::MatrixXd& points) {
  for (std::size_t p = 0; p < parameters_.size(); ++p) {
    if (slots_[p].of_other_record) continue;
    for (Eigen::Index lane = 0; lane < kLanes; ++lane) {
      const double theta = points(static_cast<Eigen::Index>(p), std::min(lane, points.cols() - 1));
      const double value = parameters_[p].to_physical(theta);
      if (slots_[p].of_change) {
        schedule_.set(slots_[p].index, static_cast<std::size_t>(lane), value);
      } else {
        ensemble_->set(slots_[p].index, static_cast<std::size_t>(lane), value);
      }
    }
  }
  schedule_.begin(*ensemble_);
}

void ObserverSimulation::innovations(const Eigen::MatrixXd& points,
                                     std::span<const InnovationGains> gains,
                                     Eigen::MatrixXd& residuals_m) {
  std::array<const InnovationGains*, kLanes> each;
  for (std::size_t lane = 0; lane < each.size(); ++lane) {
    each[lane] = &gains[std::min(lane, gains.size() - 1)];
  }
  predict(points, {}, {}, each, residuals_m);
}

void ObserverSimulation::predict(const Eigen::MatrixXd& points, const Eigen::MatrixXd& added_V,
                                 const Eigen::MatrixXd& added_N,
                                 std::span<const InnovationGains* const> gains,
                                 Eigen::MatrixXd& residuals_m) {
  using plant_sim::Ensemble;
  const Dataset& record = *record_;
  const auto lanes = static_cast<std::size_t>(points.cols());
  const auto samples = static_cast<Eigen::Index>(record.size());
  residuals_m.resize(samples, points.cols());
  take(points);
  std::vector<std::size_t> states;
  for (const std::string& name : gains.front()->states) {
    states.push_back(ensemble_->find_state(name).value());
  }
  const auto disturbed = static_cast<Eigen::Index>(states.size());
  const auto offset = ensemble_->find_state(kSecondMassOffset);
  const Ensemble::Values place = sensor_place(*ensemble_);
  const auto sensed_m = [&] {
    const double rod_m = ensemble_->state(position_)[0];
    return place[0] > 0.0 ? rod_m + place[0] * ensemble_->state(*offset)[0] : rod_m;
  };
  // otherwise the disturbance is a speed
  const bool forces = ensemble_->find("load_force.force_N").has_value();
  const auto line_m = [&](std::size_t lane, Eigen::Index k) {
    return gains[lane]->line_m.size() > 0 ? gains[lane]->line_m[k] : 0.0;
  };
  ensemble_->place_disturbance(gains.front()->force_place);
  Ensemble::Values disturbance{};
  std::size_t segment = 0;
  for (Eigen::Index k = 0; k < samples; ++k) {
    const auto row = static_cast<std::size_t>(k);
    schedule_.apply(*ensemble_, record.t_s[row], record.sample_time_s);
    if (segment < record.starts.size() && record.starts[segment] == row) {
      ensemble_->start(record.y_m[row] - line_m(0, k));
      disturbance.fill(0.0);
      ++segment;
    }
    const Ensemble::Values reading_m = ensemble_->reading_m();
    speed_mps_[row] = ensemble_->speed_mps()[0];
    predicted_.rod_m[row] = sensed_m();
    predicted_.reading_m[row] = reading_m[0];
    Ensemble::Values error_m{};
    for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) {
      error_m[lane] = record.y_m[row] - line_m(lane, k) - reading_m[lane];
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      residuals_m(k, static_cast<Eigen::Index>(lane)) =
          record.valid[row] != 0 ? error_m[lane] * gains[lane]->scale[k] : 0.0;
    }
    for (std::size_t i = 0; i < states.size(); ++i) {
      Ensemble::Values values = ensemble_->state(states[i]);
      for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) {
        values[lane] += gains[lane]->gain(static_cast<Eigen::Index>(i), k) * error_m[lane];
      }
      ensemble_->set_state(states[i], values);
      if (states[i] != offset) continue;
      Ensemble::Values back_m{};  // an offset is corrected with the reading held
      for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) {
        back_m[lane] =
            -place[lane] * gains[lane]->gain(static_cast<Eigen::Index>(i), k) * error_m[lane];
      }
      ensemble_->shift(back_m);
    }
    predicted_.correction_m[row] = sensed_m() - predicted_.rod_m[row];
    Ensemble::Values force_N{};
    Ensemble::Values moved_m{};
    for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) {
      disturbance[lane] += gains[lane]->gain(disturbed, k) * error_m[lane];
      const auto column = static_cast<Eigen::Index>(lane);
      const double added = column < added_N.cols() ? added_N(k, column) : 0.0;
      force_N[lane] = disturbance[lane] + added;
      moved_m[lane] = disturbance[lane] * record.sample_time_s;
    }
    if (forces) ensemble_->disturb(force_N);
    Ensemble::Values u_V;
    u_V.fill(record.u_V[row]);
    for (Eigen::Index lane = 0; lane < added_V.cols(); ++lane) {
      u_V[static_cast<std::size_t>(lane)] += added_V(k, lane);
    }
    ensemble_->advance(u_V, record.sample_time_s);
    if (!forces) ensemble_->shift(moved_m);
    for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) {
      disturbance[lane] *= gains[lane]->decay;
    }
  }
  ensemble_->disturb({});
  ensemble_->place_disturbance(plant_sim::kPlaceOfSensor);
  schedule_.end(*ensemble_);
}

void ObserverSimulation::run(const Eigen::MatrixXd& points, const Eigen::MatrixXd& added_V,
                             const Eigen::MatrixXd& added_N, Eigen::MatrixXd& residuals_m,
                             Chambers* chambers) {
  using plant_sim::Ensemble;
  const Dataset& record = *record_;
  const Eigen::Index lanes = points.cols();
  const auto samples = static_cast<Eigen::Index>(record.size());
  if (record.innovations && chambers == nullptr) {
    std::array<const InnovationGains*, kLanes> every;
    every.fill(record.innovations.get());
    predict(points, added_V, added_N, every, residuals_m);
    const Eigen::MatrixXd& lines = record.innovations->lines;
    if (lines.cols() > 0) residuals_m -= lines * (lines.transpose() * residuals_m).eval();
    return;
  }
  residuals_m.resize(samples, lanes);
  take(points);
  const ObserverCorrection observer(*ensemble_, record, observer_per_s_);
  std::size_t segment = 0;
  for (Eigen::Index k = 0; k < samples; ++k) {
    const auto row = static_cast<std::size_t>(k);
    schedule_.apply(*ensemble_, record.t_s[row], record.sample_time_s);
    if (segment < record.starts.size() && record.starts[segment] == row) {
      ensemble_->start(record.y_m[row]);
      ++segment;
    }
    const Ensemble::Values reading_m = ensemble_->reading_m();
    Ensemble::Values error_m{};
    for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) {
      error_m[lane] = record.y_m[row] - reading_m[lane];
    }
    const double counts = record.valid[row] != 0 ? 1.0 : 0.0;
    for (Eigen::Index lane = 0; lane < lanes; ++lane) {
      residuals_m(k, lane) = counts * error_m[static_cast<std::size_t>(lane)];
    }
    speed_mps_[row] = ensemble_->speed_mps()[0];
    predicted_.rod_m[row] = ensemble_->state(position_)[0];
    predicted_.reading_m[row] = reading_m[0];
    predicted_.correction_m[row] = observer.gain(row).position * error_m[0];
    if (chambers != nullptr) {
      const plant_sim::PressuresOf<Ensemble::Values> model = ensemble_->pressures();
      for (Eigen::Index lane = 0; lane < kLanes; ++lane) {
        chambers->in_Pa(k, lane) = model.in_Pa[static_cast<std::size_t>(lane)];
        chambers->out_Pa(k, lane) = model.out_Pa[static_cast<std::size_t>(lane)];
      }
    }
    observer.apply(*ensemble_, row, error_m);
    Ensemble::Values u_V;
    u_V.fill(record.u_V[row]);
    for (Eigen::Index lane = 0; lane < added_V.cols(); ++lane) {
      u_V[static_cast<std::size_t>(lane)] += added_V(k, lane);
    }
    if (added_N.size() > 0) {
      Ensemble::Values force_N{};
      for (Eigen::Index lane = 0; lane < added_N.cols(); ++lane) {
        force_N[static_cast<std::size_t>(lane)] = added_N(k, lane);
      }
      ensemble_->disturb(force_N);
    }
    ensemble_->advance(u_V, record.sample_time_s);
  }
  if (added_N.size() > 0) ensemble_->disturb({});
  schedule_.end(*ensemble_);
}

}  // namespace estimator::greybox
