// The two simpler plants against closed forms.
#include <gtest/gtest.h>

#include <complex>
#include <utility>

#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

TEST(VelocityServo, MovesInProportionToTheCommand) {
  auto plant = at_rest<Servo>();
  hold(*plant, -1.5, 2.0);
  EXPECT_NEAR(plant->state.y_m, -0.15, 1e-12);
  EXPECT_EQ(plant->speed_mps(), -0.05 * 1.5);
}

TEST(VelocityServo, LagsByItsTimeConstantWhateverTheStep) {
  for (const double tau_s : {0.0003, 0.02, 0.5}) {
    for (const double step_s : {1e-2, 1e-3}) {
      auto plant = at_rest<Servo>();
      plant->parameters.time_constant_s = tau_s;
      hold(*plant, 2.0, 0.3, step_s);
      const double lost_s = tau_s * (1.0 - std::exp(-0.3 / tau_s));
      EXPECT_NEAR(plant->state.y_m, 0.1 * (0.3 - lost_s), 1e-13) << tau_s << " " << step_s;
    }
  }
}

// Roots p, q of tau^2 s^2 + 2 zeta tau s + 1: the step response is 1 - (q e^pt - p e^qt) / (q - p),
// in complex numbers for zeta below 1.
TEST(VelocityServo, LagsByTheStepResponseOfSecondOrderWhateverTheStep) {
  using Complex = std::complex<double>;
  for (const double tau_s : {0.0007, 0.02, 0.3}) {
    for (const double zeta : {0.2, 0.7, 0.999, 1.5, 20.0}) {
      const Complex w = std::sqrt(Complex(zeta * zeta - 1.0));
      const Complex p = (-zeta + w) / tau_s;
      const Complex q = (-zeta - w) / tau_s;
      const double t = 0.3;
      const Complex lost_s =
          (q / p * (std::exp(p * t) - 1.0) - p / q * (std::exp(q * t) - 1.0)) / (q - p);
      const double speed = 1.0 - ((q * std::exp(p * t) - p * std::exp(q * t)) / (q - p)).real();
      for (const double step_s : {1e-2, 1e-3}) {
        auto plant = at_rest<Servo>();
        plant->parameters.time_constant_s = tau_s;
        plant->parameters.damping_ratio = zeta;
        hold(*plant, 2.0, t, step_s);
        EXPECT_NEAR(plant->state.y_m, 0.1 * (t - lost_s.real()), 1e-12) << tau_s << " " << zeta;
        EXPECT_NEAR(plant->speed_mps(), 0.1 * speed, 1e-12) << tau_s << " " << zeta;
      }
    }
  }
}

TEST(VelocityServo, HasTheDoubleRootsResponseAtCriticalDamping) {
  auto plant = at_rest<Servo>();
  plant->parameters.time_constant_s = 0.05;
  plant->parameters.damping_ratio = 1.0;
  hold(*plant, 2.0, 0.1);
  const double x = 0.1 / 0.05;
  EXPECT_NEAR(plant->speed_mps(), 0.1 * (1.0 - (1.0 + x) * std::exp(-x)), 1e-10);
}

TEST(VelocityServo, OfSecondOrderWithoutTimeConstantHasNoLag) {
  auto plant = at_rest<Servo>();
  plant->parameters.damping_ratio = 0.7;
  hold(*plant, -1.5, 2.0);
  EXPECT_NEAR(plant->state.y_m, -0.15, 1e-12);
}

TEST(VelocityServo, PassesTheDeadbandBehindTheLag) {
  const auto travel = [](double step_s) {
    auto plant = at_rest<Servo>();
    plant->parameters.time_constant_s = 0.1;
    set_effect(*plant, "deadband", "half_width_V", 0.4);
    hold(*plant, 2.0, 0.3, step_s);
    return plant->state.y_m;
  };
  // opens at t0 where 2 (1 - exp(-t/tau)) = 0.4
  const double t0 = -0.1 * std::log(0.8);
  const double exact = 0.05 * (1.6 * (0.3 - t0) - 2.0 * 0.1 * (0.8 - std::exp(-3.0)));
  EXPECT_NEAR(travel(1e-3), exact, 1e-7);
  EXPECT_NEAR(travel(1e-5), exact, 1e-10);
}

TEST(VelocityServo, IsTheActuatorsLimitForSlowMotion) {
  auto servo = at_rest<Servo>();
  auto actuator = at_rest();
  actuator->parameters.mass_kg = 1.0;
  actuator->parameters.damping_N_s_per_m = 0.0;
  servo->parameters.gain_mps_per_V = steady_speed_mps(actuator->parameters, 2.79e-5);
  hold(*actuator, 1.0, 4.0);
  const double from_m = actuator->state.y_m;
  hold(*actuator, 1.0, 1.0);
  hold(*servo, 1.0, 1.0);
  EXPECT_NEAR(servo->state.y_m, actuator->state.y_m - from_m, 1e-7);
}

TEST(ForceDrivenAxis, SpeedsUpToForceOverDamping) {
  auto plant = at_rest<Axis>();
  hold(*plant, 2.0, 0.7);
  const double expected = 2.0 * 35.0 / 200.0 * (1.0 - std::exp(-0.7 * 200.0 / 100.0));
  EXPECT_NEAR(plant->state.v_mps, expected, 1e-12);
}

TEST(ForceDrivenAxis, SlidesAgainstCoulombFrictionAndStandsBelowIt) {
  auto plant = at_rest<Axis>();
  set_effect(*plant, "friction", "coulomb_N", 30.0);
  hold(*plant, 0.8, 1.0);
  EXPECT_EQ(plant->state.y_m, 0.0);
  hold(*plant, 2.0, 15.0);
  EXPECT_NEAR(plant->state.v_mps, (70.0 - 30.0) / 200.0, 1e-9);
  hold(*plant, 0.0, 10.0);
  EXPECT_NEAR(plant->state.v_mps, 0.0, 1e-12);
}

TEST(ForceDrivenAxis, StandsOnItsBristlesHoweverStiffTheyAre) {
  // the equation itself, by Runge and Kutta's method at 1 us (0.1 us at 1e9 N/m), comes to rest at
  // 938.6 um (496.7 nm): it creeps on with each of the swings, which die out
  for (const auto& [k, rest_m] : {std::pair{1e5, 938.6e-6}, {1e9, 496.7e-9}}) {
    auto plant = at_rest<Axis>();
    plant->parameters.mass_kg = 10.0;
    set_effect(*plant, "friction", "coulomb_N", 100.0);
    set_effect(*plant, "friction", "presliding_stiffness_N_per_m", k);
    hold(*plant, 1.0, 10.0);
    // z = (g/k) (1 - exp(-k y/g)) holds 35 N at the least
    const double held_m = -100.0 / k * std::log(1.0 - 0.35);
    EXPECT_GE(plant->state.y_m, 0.999 * held_m) << k;
    EXPECT_LT(plant->state.y_m, 1.001 * rest_m) << k;
    EXPECT_LT(std::abs(plant->state.v_mps), 1e-9) << k;
  }
}

TEST(ForceDrivenAxis, CarriesAddedMass) {
  auto heavy = at_rest<Axis>();
  auto slaves = at_rest<Axis>();
  heavy->parameters.mass_kg = 130.0;
  set_effect(*slaves, "coupled_slaves", "mass_kg", 30.0);
  hold(*heavy, 2.0, 0.5);
  hold(*slaves, 2.0, 0.5);
  EXPECT_NEAR(heavy->state.v_mps, slaves->state.v_mps, 1e-14);
}

}  // namespace
}  // namespace plant_sim::testing
