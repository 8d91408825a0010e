// Shared by the plant's tests: a ready physics object and closed forms of the actuator.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <type_traits>

#include "plant_sim/plants.h"

namespace plant_sim::testing {

using Actuator = HydraulicActuator<double>;
using Servo = VelocityServo<double>;
using Axis = ForceDrivenAxis<double>;

/// Travel after which the slowest mode, the mean pressure, has settled: its time constant falls
/// with the opening as the speed grows.
inline constexpr double kSettling_m = 0.2;

/// Steady speed under a constant command: the two orifices in series against a load A (Pi - Po) =
/// d v + c v^2 + F. From Ps - Pe = 2 (A v/(G x))^2 + load/A, a quadratic in v.
inline double steady_speed_mps(const Actuator::Parameters& p, double opening_m,
                               double further_d = 0.0, double c = 0.0, double force_N = 0.0) {
  const double g = p.discharge_coefficient * p.area_gradient_m *
                   std::sqrt(2.0 / p.density_kg_per_m3) * opening_m;
  const double a2 = 2.0 * std::pow(p.area_m2 / g, 2) + c / p.area_m2;
  const double a1 = (p.damping_N_s_per_m + further_d) / p.area_m2;
  const double a0 = -(p.supply_pressure_Pa - p.return_pressure_Pa) + force_N / p.area_m2;
  return (-a1 + std::sqrt(a1 * a1 - 4.0 * a2 * a0)) / (2.0 * a2);
}

/// Sets one parameter of one effect, "friction", "coulomb_N"; false when there is none.
template <template <class> class Plant, class S>
bool set_effect(Plant<S>& plant, const std::string& effect, const std::string& name,
                const std::type_identity_t<S>& value) {
  bool found = false;
  plant.effects.each([&](auto tag, auto& parameters) {
    if (effect != decltype(tag)::Type::kName) return;
    parameters.visit([&](const ParameterInfo& info, S& target) {
      if (name != info.name) return;
      target = value;
      found = true;
    });
  });
  return found;
}

/// A servo of 50 mm/s per volt that lags by tau_s, with one parameter of an effect, at rest.
inline Servo servo_with(const std::string& effect, const std::string& name, double value,
                        double tau_s) {
  Servo servo;
  servo.parameters.gain_mps_per_V = 0.05;
  servo.parameters.time_constant_s = tau_s;
  set_effect(servo, effect, name, value);
  servo.prepare(1e-3);
  servo.reset();
  return servo;
}

/// Runs with u held for the time.
template <class Plant>
void hold(Plant& plant, double u_V, double duration_s, double step_s = 1e-3) {
  plant.prepare(step_s);
  const long steps = std::lround(duration_s / step_s);
  for (long i = 0; i < steps; ++i) plant.step(u_V);
}

template <class Plant = Actuator>
std::unique_ptr<Plant> at_rest() {
  auto plant = std::make_unique<Plant>();
  plant->prepare(1e-3);
  plant->reset();
  return plant;
}

}  // namespace plant_sim::testing
