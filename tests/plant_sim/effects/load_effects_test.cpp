// The effects on oil, rod and sensor, each against its own closed form.
#include <gtest/gtest.h>

#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

TEST(InternalLeakage, LetsALoadedRodDriftBehindAShutValve) {
  auto plant = at_rest();
  set_effect(*plant, "internal_leakage", "conductance_m3ps_per_Pa", 2e-12);
  set_effect(*plant, "load_force", "force_N", 800.0);
  hold(*plant, 0.0, 4.0);
  // A (Pi - Po) = F + d v and A v = -C (Pi - Po)
  const double expected = -800.0 * 2e-12 / (6.33e-4 * 6.33e-4 + 1000.0 * 2e-12);
  EXPECT_NEAR(plant->state.v_mps, expected, 1e-6 * std::abs(expected));
}

TEST(ExternalLeakage, LetsBothPressuresFallExponentially) {
  auto plant = at_rest();
  set_effect(*plant, "external_leakage", "conductance_m3ps_per_Pa", 2e-12);
  hold(*plant, 0.0, 0.3);
  const double rate_per_s = 6.89e8 * 2e-12 / (1e-5 + 6.33e-4 * 0.305);
  EXPECT_NEAR(plant->state.in_Pa, 3.445e6 * std::exp(-0.3 * rate_per_s), 1e-2);
  EXPECT_NEAR(plant->state.out_Pa, plant->state.in_Pa, 1e-2);
  EXPECT_NEAR(plant->state.y_m, 0.305, 1e-9);
}

TEST(EntrainedAir, IsTheModulusOfOilAndBubblesSqueezedTogether) {
  // volume against pressure: oil 1 - p/beta, air alpha (pa/p)^(1/1.4); beta_eff = -V dp/dV
  for (const double alpha : {0.001, 0.02, 0.3}) {
    const effects::EntrainedAir<double>::Parameters p{alpha};
    double last_Pa = 0.0;
    for (const double gauge_Pa : {0.0, 1e5, 3.4e6, 6.89e6}) {
      const double p_Pa = gauge_Pa + 1.01e5;
      const auto air = [&](double at_Pa) { return alpha * std::pow(1.01e5 / at_Pa, 1.0 / 1.4); };
      const double h_Pa = 1e-4 * p_Pa;
      const double shrinks_per_Pa =
          1.0 / 6.89e8 + (air(p_Pa - h_Pa) - air(p_Pa + h_Pa)) / (2.0 * h_Pa);
      const double found_Pa = effects::EntrainedAir<double>::bulk_modulus_Pa(p, 6.89e8, gauge_Pa);
      EXPECT_NEAR(found_Pa * shrinks_per_Pa / (1.0 + air(p_Pa)), 1.0, 1e-6);
      EXPECT_GT(found_Pa, last_Pa);
      EXPECT_LT(found_Pa, 6.89e8);
      last_Pa = found_Pa;
    }
  }
}

TEST(QuadraticDamping, SlowsTheRodToTheSpeedOfTheClosedForm) {
  auto plant = at_rest();
  set_effect(*plant, "quadratic_damping", "coefficient_N_s2_per_m2", 5e4);
  hold(*plant, -1.0, 4.0);
  const double expected = steady_speed_mps(plant->parameters, 2.79e-5, 0.0, 5e4);
  EXPECT_NEAR(plant->state.v_mps, -expected, 1e-9);
}

TEST(LoadSpring, HoldsTheAxisWhereItBalancesTheForce) {
  auto plant = at_rest<Axis>();
  set_effect(*plant, "load_spring", "stiffness_N_per_m", 5000.0);
  set_effect(*plant, "load_spring", "rest_m", 0.1);
  hold(*plant, 4.0, 40.0);
  EXPECT_NEAR(plant->state.y_m, 0.1 + 4.0 * 35.0 / 5000.0, 1e-9);
}

TEST(LoadSpring, SwingsAtItsNaturalFrequencyHoweverStiff) {
  for (const double k : {1e3, 1e7, 1e9}) {
    auto plant = at_rest<Axis>();
    plant->parameters.damping_N_s_per_m = 0.0;
    set_effect(*plant, "load_spring", "stiffness_N_per_m", k);
    plant->prepare(1e-3);
    plant->state.y_m = 1e-3;
    const double period_s = 2.0 * M_PI / std::sqrt(k / 100.0);
    const double steps = std::ceil(period_s / 1e-3);
    hold(*plant, 0.0, steps * 1e-3, 1e-3);
    EXPECT_NEAR(plant->state.y_m, 1e-3 * std::cos(2.0 * M_PI * steps * 1e-3 / period_s),
                1e-3 * (k > 1e8 ? 0.1 : 0.03))
        << k;
  }
}

TEST(LoadForce, SlowsExtensionAndSpeedsUpRetraction) {
  for (const double u_V : {1.0, -1.0}) {
    auto plant = at_rest();
    set_effect(*plant, "load_force", "force_N", 900.0);
    const double expected = steady_speed_mps(plant->parameters, 2.79e-5, 0.0, 0.0, 900.0 * u_V);
    hold(*plant, u_V, kSettling_m / expected);
    EXPECT_NEAR(plant->state.v_mps, u_V * expected, 1e-6 * expected);
  }
}

TEST(ForceRipple, RepeatsWithItsWavelengthAlongTheStroke) {
  auto plant = at_rest();
  set_effect(*plant, "force_ripple", "amplitude_N", 50.0);
  set_effect(*plant, "force_ripple", "wavelength_m", 0.01);
  hold(*plant, 0.3, 4.0);
  std::vector<double> crossings_m;
  double last_N = 0.0;
  const double mean_N = 1000.0 * steady_speed_mps(plant->parameters, 0.3 * 2.79e-5);
  for (int k = 0; k < 5000; ++k) {
    hold(*plant, 0.3, 1e-3);
    const double ripple_N = 6.33e-4 * (plant->state.in_Pa - plant->state.out_Pa) - mean_N;
    if (last_N < 0.0 && ripple_N >= 0.0) crossings_m.push_back(plant->state.y_m);
    last_N = ripple_N;
  }
  ASSERT_GE(crossings_m.size(), 4U);
  for (std::size_t i = 1; i < crossings_m.size(); ++i) {
    EXPECT_NEAR(crossings_m[i] - crossings_m[i - 1], 0.01, 1e-4);
    // the oil follows at once, so the force crosses zero where the sine does
    EXPECT_NEAR(std::remainder(crossings_m[i], 0.01), 0.0, 2e-4);
  }
}

TEST(ForceRipple, IsTheSumOfASineAndItsSecondHarmonic) {
  using Ripple = effects::ForceRipple<double>;
  Ripple::Parameters p;
  p.amplitude_N = 12.0;
  p.wavelength_m = 0.016;
  p.phase_rad = 0.7;
  p.second_sin_N = 3.0;
  p.second_cos_N = -2.0;
  double steepest = 0.0;
  for (double y_m = 0.0; y_m < 0.016; y_m += 1e-5) {
    const double wave_rad = 2.0 * M_PI * y_m / 0.016 + 0.7;
    EXPECT_NEAR(
        Ripple::resisting_N(p, y_m, 0.0),
        12.0 * std::sin(wave_rad) + 3.0 * std::sin(2.0 * wave_rad) - 2.0 * std::cos(2.0 * wave_rad),
        1e-9)
        << y_m;
    const double slope =
        12.0 * std::cos(wave_rad) + 6.0 * std::cos(2.0 * wave_rad) + 4.0 * std::sin(2.0 * wave_rad);
    steepest = std::max(steepest, std::abs(slope) * 2.0 * M_PI / 0.016);
  }
  // what divides a step is no less than the steepest place
  EXPECT_GE(Ripple::stiffness_N_per_m(p), steepest);
  EXPECT_LE(Ripple::stiffness_N_per_m(p), 2.0 * steepest);
}

TEST(CoupledSlaves, AddMassAndDampingLikeAHeavierRod) {
  Actuator slaves;
  set_effect(slaves, "coupled_slaves", "mass_kg", 30.0);
  set_effect(slaves, "coupled_slaves", "damping_N_s_per_m", 2500.0);
  Actuator heavy;
  heavy.parameters.mass_kg = 80.0;
  heavy.parameters.damping_N_s_per_m = 3500.0;
  for (Actuator* plant : {&slaves, &heavy}) {
    plant->prepare(1e-3);
    plant->reset();
    for (int k = 0; k < 3000; ++k) plant->step(2.0 * std::sin(k * 0.01));
  }
  EXPECT_NEAR(slaves.state.y_m, heavy.state.y_m, 1e-12);
}

TEST(CoupledSlaves, NeedleResistsWithTheSquareOfTheSpeed) {
  auto plant = at_rest();
  set_effect(*plant, "coupled_slaves", "needle_N_s2_per_m2", 3e4);
  hold(*plant, 1.0, 4.0);
  const double expected = steady_speed_mps(plant->parameters, 2.79e-5, 0.0, 3e4);
  EXPECT_NEAR(plant->state.v_mps, expected, 1e-9);
}

TEST(Backlash, LosesItsWidthAtEveryReversal) {
  auto plant = at_rest<Servo>();
  set_effect(*plant, "backlash", "width_m", 0.004);
  const auto ahead_m = [&](double u_V, double time_s) {
    hold(*plant, u_V, time_s);
    return plant->effects.reading_m(plant->state.y_m) - plant->state.y_m;
  };
  EXPECT_NEAR(ahead_m(1.0, 0.02), -0.001, 1e-12);  // from the middle, 1 mm on
  EXPECT_NEAR(ahead_m(1.0, 1.0), -0.002, 1e-12);
  const double held_m = plant->effects.reading_m(plant->state.y_m);
  EXPECT_NEAR(ahead_m(-1.0, 0.07), -0.002 + 0.0035, 1e-12);
  EXPECT_NEAR(plant->effects.reading_m(plant->state.y_m), held_m, 1e-12);
  EXPECT_NEAR(ahead_m(-1.0, 0.07), 0.002, 1e-12);
}

TEST(EncoderEccentricity, SwingsOncePerTurn) {
  auto plant = at_rest<Servo>();
  set_effect(*plant, "encoder_eccentricity", "amplitude_m", 1e-4);
  set_effect(*plant, "encoder_eccentricity", "wavelength_m", 0.02);
  set_effect(*plant, "encoder_eccentricity", "phase_rad", 0.5);
  plant->prepare(1e-3);
  for (const double y_m : {0.0, 0.003, 0.011, -0.5}) {
    const double expected = y_m + 1e-4 * std::sin(y_m / 0.02 * 2.0 * M_PI + 0.5);
    EXPECT_NEAR(plant->effects.reading_m(y_m), expected, 1e-15);
    EXPECT_NEAR(plant->effects.reading_m(y_m + 0.02), expected + 0.02, 1e-15);
  }
}

}  // namespace
}  // namespace plant_sim::testing
