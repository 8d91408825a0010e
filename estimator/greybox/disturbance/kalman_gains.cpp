#include "estimator/greybox/disturbance/kalman_gains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "estimator/greybox/disturbance/predictor.h"
#include "estimator/greybox/disturbance/riccati_lanes.h"
#include "estimator/greybox/observer_simulation.h"

namespace estimator::greybox::disturbance {
namespace {

/// Initial standard deviations of the load pressure: where a segment begins at rest, and in motion.
/// The chambers' mean is that of the simulation's start: the position hardly shows it, so that its
/// gains, large and without end, would turn any drift of a model into a pressure.
constexpr double kPressureAtRest_Pa = 1e5;
constexpr double kPressureMoving_Pa = 1e6;

double fastest_mps(const Linearisation& model) {
  double fastest = 0.0;
  for (const double v_mps : model.speed_mps) fastest = std::max(fastest, std::abs(v_mps));
  return fastest;
}

StateMatrix start_covariance(const Linearisation& model, const Dataset& record, std::size_t k,
                             const NoiseParameters& noise, double fastest_mps) {
  const Initialisation begins = k < record.initialising.size()
                                    ? static_cast<Initialisation>(record.initialising[k])
                                    : kNotInitialising;
  const bool moving =
      begins > (start_of(model.states) == PlantStart::any_speed ? kNotInitialising : kFromRest);
  const double pressure_Pa = moving ? kPressureMoving_Pa : kPressureAtRest_Pa;
  StateMatrix p = StateMatrix::Zero();
  p(0, 0) = noise.sensor_m * noise.sensor_m;
  p(kDisturbance, kDisturbance) = noise.disturbance_sd * noise.disturbance_sd;
  StateVector load_Pa = StateVector::Zero();
  for (std::size_t i = 1; i < model.states.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (model.states[i] == "v_mps" && moving) p(row, row) = fastest_mps * fastest_mps;
    if (model.states[i] == "pressure_in_Pa") load_Pa[row] = pressure_Pa;
    if (model.states[i] == "pressure_out_Pa") load_Pa[row] = -pressure_Pa;
  }
  p += load_Pa * load_Pa.transpose();
  return p;
}

double decay_of(const NoiseParameters& noise, double sample_time_s) {
  return std::exp(-2.0 * std::numbers::pi * noise.corner_Hz * sample_time_s);
}

/// P <- A P A' + Q.
void propagate(StateMatrix& p, StateMatrix a, double decay, const NoiseParameters& noise) {
  a(kDisturbance, kDisturbance) = decay;
  p = (a * p * a.transpose()).eval();
  p(0, 0) += noise.walk_m * noise.walk_m;
  p(kDisturbance, kDisturbance) +=
      (1.0 - decay * decay) * noise.disturbance_sd * noise.disturbance_sd;
}

}  // namespace

std::vector<KalmanGains> kalman_gains(const Linearisation& model, const Dataset& record,
                                      std::span<const NoiseParameters> noise, double floor_m) {
  const auto samples = static_cast<Eigen::Index>(record.size());
  const auto count = static_cast<Eigen::Index>(model.states.size());
  std::vector<KalmanGains> all(noise.size());
  const double most_mps = fastest_mps(model);
  for (std::size_t first = 0; first < noise.size(); first += kNoiseLanes) {
    const std::size_t lanes = std::min(kNoiseLanes, noise.size() - first);
    LaneNoise each;
    std::array<LaneResult, kNoiseLanes> results;
    for (std::size_t lane = 0; lane < kNoiseLanes; ++lane) {
      const NoiseParameters& one = noise[first + std::min(lane, lanes - 1)];
      each.decay[lane] = decay_of(one, record.sample_time_s);
      each.disturbance_variance[lane] = one.disturbance_sd * one.disturbance_sd;
      each.walk_m2[lane] = one.walk_m * one.walk_m;
      each.sensor_m2[lane] = one.sensor_m * one.sensor_m;
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      InnovationGains& gains = all[first + lane].gains;
      gains.states = model.states;
      gains.decay = each.decay[lane];
      gains.force_place = model.force_place;
      gains.gain.resize(count + 1, samples);
      gains.scale.resize(samples);
      results[lane] = {gains.gain.data(), gains.scale.data()};
    }
    std::array<StateMatrix, kNoiseLanes> start;
    start.fill(StateMatrix::Zero());
    std::size_t from = 0;
    for (std::size_t segment = 0; segment <= record.starts.size(); ++segment) {
      const bool last = segment == record.starts.size();
      const std::size_t to = last ? record.size() : record.starts[segment];
      riccati({&model, record.valid.data(), from, to, floor_m}, start, each, results, lanes);
      for (std::size_t lane = 0; lane < lanes && !last; ++lane) {
        start[lane] = start_covariance(model, record, to, noise[first + lane], most_mps);
      }
      from = to;
    }
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      all[first + lane].log_determinant = results[lane].log_determinant;
    }
  }
  return all;
}

KalmanGains kalman_gains(const Linearisation& model, const Dataset& record,
                         const NoiseParameters& noise, double floor_m) {
  return std::move(kalman_gains(model, record, std::span(&noise, 1), floor_m).front());
}

double disturbed_rms_m(const Linearisation& model, const Dataset& record,
                       const NoiseParameters& noise) {
  const double decay = decay_of(noise, record.sample_time_s);
  StateMatrix p = StateMatrix::Zero();
  double sum_m2 = 0.0;
  double counted = 0.0;
  const PlantStart plant = start_of(model.states);
  std::size_t segment = 0;
  for (std::size_t k = 0; k < record.size(); ++k) {
    if (segment < record.starts.size() && record.starts[segment] == k) {
      p = StateMatrix::Zero();
      p(kDisturbance, kDisturbance) = noise.disturbance_sd * noise.disturbance_sd;
      ++segment;
    }
    const double r_m2 = noise.sensor_m * noise.sensor_m;
    if (record.valid[k] != 0) {
      sum_m2 += p(0, 0) + r_m2;
      counted += 1.0;
    }
    const ObserverGain gain = record.observer_gain(k, kObserver_per_s, plant);
    StateVector l = StateVector::Zero();
    l[0] = gain.position;
    l[1] = gain.speed_per_s;  // the speed, where it is corrected
    StateMatrix correct = StateMatrix::Identity();
    correct.col(0) -= l;
    p = (correct * p * correct.transpose()).eval();
    p += r_m2 * l * l.transpose();
    propagate(p, model.transition[k], decay, noise);
  }
  return std::sqrt(sum_m2 / std::max(counted, 1.0));
}

}  // namespace estimator::greybox::disturbance
