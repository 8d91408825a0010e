#include "estimator/greybox/disturbance/kalman_gains.h"

#include <cmath>
#include <numbers>

#include "estimator/greybox/disturbance/predictor.h"
#include "estimator/greybox/observer_simulation.h"

namespace estimator::greybox::disturbance {
namespace {

/// Initial standard deviations of the load pressure: where a segment begins at rest, and in motion.
/// The chambers' mean is that of the simulation's start: the position hardly shows it, so that its
/// gains, large and without end, would turn any drift of a model into a pressure.
constexpr double kPressureAtRest_Pa = 1e5;
constexpr double kPressureMoving_Pa = 1e6;

StateMatrix start_covariance(const Linearisation& model, const Dataset& record, std::size_t k,
                             const NoiseParameters& noise) {
  const bool moving = k < record.initialising.size() && record.initialising[k] != kNotInitialising;
  double fastest_mps = 0.0;
  for (const double v_mps : model.speed_mps) fastest_mps = std::max(fastest_mps, std::abs(v_mps));
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

KalmanGains kalman_gains(const Linearisation& model, const Dataset& record,
                         const NoiseParameters& noise, double floor_m) {
  const auto samples = static_cast<Eigen::Index>(record.size());
  const auto count = static_cast<Eigen::Index>(model.states.size());
  KalmanGains result;
  result.gains.states = model.states;
  result.gains.decay = decay_of(noise, record.sample_time_s);
  result.gains.gain.resize(count + 1, samples);
  result.gains.scale.resize(samples);
  StateMatrix p = StateMatrix::Zero();
  std::size_t segment = 0;
  for (Eigen::Index k = 0; k < samples; ++k) {
    const auto row = static_cast<std::size_t>(k);
    if (segment < record.starts.size() && record.starts[segment] == row) {
      p = start_covariance(model, record, row, noise);
      ++segment;
    }
    const double s_m2 = p(0, 0) + noise.sensor_m * noise.sensor_m;
    const StateVector gain = p.col(0) / s_m2;
    result.gains.gain.col(k).head(count) = gain.head(count);
    result.gains.gain(count, k) = gain[kDisturbance];
    result.gains.scale[k] = floor_m / std::sqrt(s_m2);
    if (record.valid[row] != 0) {
      result.log_determinant += std::log(s_m2 / (floor_m * floor_m));
    }
    p -= gain * p.row(0).eval();
    p = (0.5 * (p + p.transpose())).eval();
    propagate(p, model.transition[row], result.gains.decay, noise);
  }
  return result;
}

double disturbed_rms_m(const Linearisation& model, const Dataset& record,
                       const NoiseParameters& noise) {
  const double decay = decay_of(noise, record.sample_time_s);
  StateMatrix p = StateMatrix::Zero();
  double sum_m2 = 0.0;
  double counted = 0.0;
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
    StateMatrix correct = StateMatrix::Identity();
    const double l = record.observer_gain(k, kObserver_per_s);
    correct(0, 0) -= l;
    p = (correct * p * correct.transpose()).eval();
    p(0, 0) += l * l * r_m2;
    propagate(p, model.transition[k], decay, noise);
  }
  return std::sqrt(sum_m2 / std::max(counted, 1.0));
}

}  // namespace estimator::greybox::disturbance
