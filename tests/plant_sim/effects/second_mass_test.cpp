// A second mass behind a spring, against the closed forms of two bodies.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

struct Body {
  double mass_ratio = 0.3;
  double resonance_Hz = 34.0;
  double damping_ratio = 0.03;
  double sensor_ratio = 0.0;
};

template <class Plant>
void hang(Plant& plant, const Body& body) {
  ASSERT_TRUE(set_effect(plant, "second_mass", "mass_ratio", body.mass_ratio));
  ASSERT_TRUE(set_effect(plant, "second_mass", "resonance_Hz", body.resonance_Hz));
  ASSERT_TRUE(set_effect(plant, "second_mass", "damping_ratio", body.damping_ratio));
  ASSERT_TRUE(set_effect(plant, "second_mass", "sensor_ratio", body.sensor_ratio));
}

/// A constant force F on the first of two free bodies M: their centre goes F t^2 / 2M, and the
/// second falls behind by F/(m1 w^2) times the step response of the resonance.
double reading_under_force_m(const Body& body, double force_N, double mass_kg, double t_s) {
  const double w = 2.0 * std::numbers::pi * body.resonance_Hz;
  const double zeta = body.damping_ratio;
  const double wd = w * std::sqrt(1.0 - zeta * zeta);
  const double step =
      1.0 - std::exp(-zeta * w * t_s) * (std::cos(wd * t_s) + zeta * w / wd * std::sin(wd * t_s));
  const double ahead_m = -force_N / ((1.0 - body.mass_ratio) * mass_kg * w * w) * step;
  const double centre_m = 0.5 * force_N / mass_kg * t_s * t_s;
  return centre_m + (body.sensor_ratio - body.mass_ratio) * ahead_m;
}

TEST(SecondMass, SwingsOnAnAxisAsTwoFreeBodiesDo) {
  for (const Body& body : {Body{}, Body{0.3, 34.0, 0.03, 1.0}, Body{0.8, 8.0, 0.2, 0.5},
                           Body{0.1, 300.0, 0.02, 0.0}}) {
    auto plant = at_rest<Axis>();
    plant->parameters.damping_N_s_per_m = 0.0;
    hang(*plant, body);
    const double w = 2.0 * std::numbers::pi * body.resonance_Hz;
    const double swing_m = 35.0 / (100.0 * (1.0 - body.mass_ratio) * w * w);
    double worst_m = 0.0;
    for (int k = 1; k <= 200; ++k) {
      hold(*plant, 1.0, 1e-3);
      const double truth_m = reading_under_force_m(body, 35.0, 100.0, k * 1e-3);
      worst_m = std::max(worst_m, std::abs(plant->effects.reading_m(plant->state.y_m) - truth_m));
    }
    // limits::kResonanceStep: 0.1 % of the frequency is 4 % of a swing after 60 of its periods
    EXPECT_LT(worst_m, 0.05 * swing_m) << body.resonance_Hz;
    if (body.resonance_Hz < 50.0) {
      EXPECT_LT(worst_m, 1e-3 * swing_m) << body.resonance_Hz;
    }
  }
}

/// From outside, a force acts on the mass that the sensor is on: by the closed form with the two
/// bodies exchanged where that is the second.
TEST(SecondMass, IsPushedFromOutsideWhereTheSensorIs) {
  constexpr double kForce_N = 35.0;
  for (const double place : {0.0, 1.0}) {
    const Body body{0.3, 34.0, 0.03, place};
    auto plant = at_rest<Axis>();
    plant->parameters.damping_N_s_per_m = 0.0;
    hang(*plant, body);
    plant->disturbance_N = -kForce_N;  // a resistance
    const Body seen{place > 0.5 ? 1.0 - body.mass_ratio : body.mass_ratio, body.resonance_Hz,
                    body.damping_ratio, 0.0};
    const double w = 2.0 * std::numbers::pi * body.resonance_Hz;
    const double swing_m = kForce_N / (100.0 * (1.0 - seen.mass_ratio) * w * w);
    for (int k = 1; k <= 200; ++k) {
      hold(*plant, 0.0, 1e-3);
      EXPECT_NEAR(plant->effects.reading_m(plant->state.y_m),
                  reading_under_force_m(seen, kForce_N, 100.0, k * 1e-3), 1e-3 * swing_m)
          << place;
    }
  }
}

TEST(SecondMass, PassesAForceFromOutsideOnHoweverLittleItWeighs) {
  for (const double ratio : {0.4, 0.005, 0.0}) {
    auto plant = at_rest<Axis>();
    plant->parameters.damping_N_s_per_m = 0.0;
    hang(*plant, {ratio, 34.0, 0.3, 1.0});
    plant->disturbance_N = -35.0;
    hold(*plant, 0.0, 1.0);
    EXPECT_NEAR(plant->state.v_mps, 0.35, 1e-3) << ratio;  // F t / M
  }
}

TEST(SecondMass, AddsNothingToTheMassOfSlowMotion) {
  auto rigid = at_rest<Axis>();
  auto flexible = at_rest<Axis>();
  hang(*flexible, {0.5, 60.0, 0.1, 0.0});
  hold(*rigid, 1.0, 2.0);
  hold(*flexible, 1.0, 2.0);
  EXPECT_NEAR(flexible->state.v_mps, rigid->state.v_mps, 1e-5 * rigid->state.v_mps);
}

TEST(SecondMass, KeepsTheEnergyOfARodSwingingOnShutOil) {
  Actuator plant;
  plant.parameters.damping_N_s_per_m = 0.0;
  const Body body{0.4, 20.0, 0.0, 0.0};
  hang(plant, body);
  plant.prepare(1e-4);
  plant.reset();
  plant.state.v_mps = 0.2;
  const double m1 = (1.0 - body.mass_ratio) * plant.parameters.mass_kg;
  const double m2 = body.mass_ratio * plant.parameters.mass_kg;
  const double w = 2.0 * std::numbers::pi * body.resonance_Hz;
  const double k = m1 * m2 / (m1 + m2) * w * w;
  const double beta = plant.parameters.bulk_modulus_Pa;
  const auto in_m3 = [&] {
    return plant.parameters.dead_volume_m3 + plant.parameters.area_m2 * plant.state.y_m;
  };
  const auto out_m3 = [&] {
    return plant.parameters.dead_volume_m3 +
           plant.parameters.area_m2 * (plant.parameters.stroke_m - plant.state.y_m);
  };
  // p = c - beta ln V in either chamber; its energy is the integral of -p dV
  const double in_Pa = plant.state.in_Pa + beta * std::log(in_m3());
  const double out_Pa = plant.state.out_Pa + beta * std::log(out_m3());
  const auto oil = [&](double c_Pa, double m3) {
    return -(c_Pa * m3 - beta * (m3 * std::log(m3) - m3));
  };
  const auto joules = [&] {
    const auto z = plant.effects.offset();
    const double v2 = plant.state.v_mps + z.offset_mps;
    return 0.5 * m1 * plant.state.v_mps * plant.state.v_mps + 0.5 * m2 * v2 * v2 +
           0.5 * k * z.offset_m * z.offset_m + oil(in_Pa, in_m3()) + oil(out_Pa, out_m3());
  };
  plant.effects.set_offset({0.0, -0.2});  // the second mass starts at rest
  const double start_J = joules();
  double most_m = 0.0;
  for (int n = 0; n < 5000; ++n) {
    plant.step(0.0);
    most_m = std::max(most_m, std::abs(plant.effects.offset().offset_m));
    ASSERT_NEAR(joules(), start_J, 1e-4) << n;  // of 0.6 J in motion
  }
  EXPECT_GT(most_m, 1e-4);
}

TEST(SecondMass, GoesOnWhenTheRodHitsItsStop) {
  Actuator plant;
  hang(plant, {0.5, 5.0, 0.05, 0.0});
  plant.initial.y_m = 0.6;
  plant.prepare(1e-3);
  plant.reset();
  double before_mps = 0.0;
  while (plant.state.y_m < plant.parameters.stroke_m) {
    before_mps = plant.state.v_mps + plant.effects.offset().offset_mps;
    plant.step(5.0);
  }
  EXPECT_EQ(plant.state.v_mps, 0.0);
  ASSERT_GT(before_mps, 0.02);
  EXPECT_NEAR(plant.effects.offset().offset_mps, before_mps, 0.1 * before_mps);
}

}  // namespace
}  // namespace plant_sim::testing
