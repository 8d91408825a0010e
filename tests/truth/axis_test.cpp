// The electric axis against what can be worked out by hand.
#include "tests/truth/axis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/truth/rig.h"

namespace truth {
namespace {

constexpr double kPi = 3.14159265358979;

Rig rig_of(const AxisPlant& plant, const Hidden& hidden = {}, const LeftOut& left_out = {},
           const Outside& outside = {}) {
  return Rig(std::make_unique<Axis>(plant, hidden, left_out), 0, outside);
}

AxisPlant without_damping() {
  AxisPlant plant;
  plant.damping_N_s_per_m = 0.0;
  return plant;
}

void hold_for(Rig& rig, double u_V, double span_s) {
  const long samples = std::lround(span_s / kSample_s);
  for (long k = 0; k < samples; ++k) rig.hold(u_V);
}

TEST(TruthAxis, NearsItsSpeedByTheExponentialOfMassAndDamping) {
  for (const bool rotary : {false, true}) {
    const AxisPlant p = printed_axis(rotary);
    Rig rig = rig_of(p);
    hold_for(rig, 1.5, 0.4);
    const double last_mps = 1.5 * p.gain_N_per_V / p.damping_N_s_per_m;
    const double lag_s = p.mass_kg / p.damping_N_s_per_m;
    const double gone = 1.0 - std::exp(-0.4 / lag_s);
    EXPECT_NEAR(rig.x[1], last_mps * gone, 1e-7 * last_mps);
    EXPECT_NEAR(rig.x[0] - kCentre_m, last_mps * (0.4 - lag_s * gone), 1e-7 * last_mps);
  }
}

TEST(TruthAxis, SlidesAtTheBalanceOfDriveDampingAndStribecksCurve) {
  Hidden hidden;
  hidden.coulomb_N = 10.0;
  hidden.static_N = 14.0;
  hidden.stribeck_mps = 0.1;
  hidden.presliding_N_per_m = 1e6;
  const AxisPlant p;
  Rig rig = rig_of(p, hidden);
  hold_for(rig, 1.0, 8.0);
  double v = 0.0;
  for (int i = 0; i < 200; ++i) {
    v = (p.gain_N_per_V - 10.0 - 4.0 * std::exp(-std::pow(v / 0.1, 2))) / p.damping_N_s_per_m;
  }
  EXPECT_NEAR(rig.x[1], v, 1e-4 * v);
}

TEST(TruthAxis, SticksOnItsBristlesBelowTheBreakawayForce) {
  Hidden hidden;
  hidden.coulomb_N = 10.0;
  hidden.static_N = 14.0;
  hidden.presliding_N_per_m = 1e6;
  hidden.bristle_N_s_per_m = 2000.0;
  Rig rig = rig_of({}, hidden);
  const double push_N = 0.2 * AxisPlant{}.gain_N_per_V;
  hold_for(rig, 0.2, 4.0);
  EXPECT_NEAR(rig.x[1], 0.0, 1e-6);
  EXPECT_GT(rig.x[0] - kCentre_m, 0.9 * push_N / 1e6);
  EXPECT_LT(rig.x[0] - kCentre_m, 10.0 * push_N / 1e6);  // with the creep of the way there
}

TEST(TruthAxis, SwingsOnALoadSpringAtTheRootOfStiffnessOverMass) {
  Hidden hidden;
  hidden.spring_N_per_m = 300.0;
  hidden.rest_m = 0.3;
  Rig rig = rig_of(without_damping(), hidden);
  const double half_s = kPi * std::sqrt(100.0 / 300.0);
  hold_for(rig, 0.0, kSample_s * std::floor(half_s / kSample_s));
  const double rest_s = half_s - kSample_s * std::floor(half_s / kSample_s);
  EXPECT_NEAR(rig.x[0] + rest_s * rig.x[1], 0.295, 1e-6);
  Rig held = rig_of({}, hidden);
  hold_for(held, 0.1, 30.0);
  EXPECT_NEAR(held.x[0], 0.3 + 0.1 * 35.0 / 300.0, 1e-6);
}

TEST(TruthAxis, KeepsItsEnergyOverARipple) {
  Hidden hidden;
  hidden.ripple_N = 12.0;
  hidden.ripple_wavelength_m = 0.016;
  hidden.ripple_phase_rad = 0.7;
  hidden.ripple_second_sin_N = 3.0;
  hidden.ripple_second_cos_N = -2.0;
  Rig rig = rig_of(without_damping(), hidden);
  rig.x[1] = 0.1;
  const auto energy_J = [&] {
    const double turn = 2.0 * kPi * rig.x[0] / 0.016 + 0.7;
    const double along_N =
        12.0 * std::cos(turn) + 1.5 * std::cos(2.0 * turn) + 1.0 * std::sin(2.0 * turn);
    return 50.0 * rig.x[1] * rig.x[1] - 0.016 / (2.0 * kPi) * along_N;
  };
  const double before_J = energy_J();
  double least_mps = 0.1;
  for (int k = 0; k < 400; ++k) {
    rig.hold(0.0);
    least_mps = std::min(least_mps, rig.x[1]);
    EXPECT_NEAR(energy_J(), before_J, 1e-6 * before_J);
  }
  EXPECT_LT(least_mps, 0.0999);
}

TEST(TruthAxis, LosesSpeedToAQuadraticDragAndToALoad) {
  Hidden hidden;
  hidden.quadratic_N_s2_per_m2 = 400.0;
  Rig dragged = rig_of({}, hidden);
  hold_for(dragged, 2.0, 10.0);
  // 400 v^2 + 200 v = 70
  const double v_mps = (-200.0 + std::sqrt(200.0 * 200.0 + 4.0 * 400.0 * 70.0)) / 800.0;
  EXPECT_NEAR(dragged.x[1], v_mps, 1e-6);
  Hidden load;
  load.force_N = 8.0;
  Rig loaded = rig_of({}, load);
  hold_for(loaded, 2.0, 10.0);
  EXPECT_NEAR(loaded.x[1], 62.0 / 200.0, 1e-6);
}

TEST(TruthAxis, ShakesUnderALineOfForceAsMassAndDampingLet) {
  Outside outside;
  outside.line_N = 20.0;
  outside.line_Hz = 20.0;
  Rig rig = rig_of({}, {}, {}, outside);
  hold_for(rig, 0.0, 6.0);
  double in = 0.0;
  double out = 0.0;
  for (int k = 0; k < 400; ++k) {  // forty periods
    const double turn = 2.0 * kPi * 20.0 * k * kSample_s;
    in += 2.0 / 400.0 * (rig.x[0] - kCentre_m) * std::cos(turn);
    out += 2.0 / 400.0 * (rig.x[0] - kCentre_m) * std::sin(turn);
    rig.hold(0.0);
  }
  const double w = 2.0 * kPi * 20.0;
  const double expected_m = 20.0 / std::hypot(100.0 * w * w, 200.0 * w);
  EXPECT_NEAR(std::hypot(in, out), expected_m, 2e-3 * expected_m);
}

TEST(TruthAxis, TwistsItsElasticShaftByTheLoadsInertia) {
  const LeftOut shaft{LeftOut::Kind::elastic_shaft, 3e5, 0.0};
  Rig pushed = rig_of(without_damping(), {}, shaft);
  hold_for(pushed, 1.0, 10.0);
  const double acceleration_mps2 = 35.0 / 100.0;
  EXPECT_NEAR(pushed.x[2], 60.0 * acceleration_mps2 / 3e5, 1e-9);
  EXPECT_NEAR(pushed.x[1], 10.0 * acceleration_mps2, 1e-4);
}

TEST(TruthAxis, RingsOnItsElasticShaftAtTheReducedMass) {
  const LeftOut shaft{LeftOut::Kind::elastic_shaft, 3e5, 0.0};
  const Axis axis(without_damping(), {}, shaft);
  State x = axis.rest(kCentre_m);
  x[2] = 1e-3;
  const double w = std::sqrt(3e5 / 24.0);
  const double zeta = 0.02;
  const double period_s = 2.0 * kPi / (w * std::sqrt(1.0 - zeta * zeta));
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) axis.step(x, 0.0, 0.0, period_s / kSteps);
  EXPECT_NEAR(x[2], 1e-3 * std::exp(-zeta * w * period_s), 1e-8);
  EXPECT_NEAR(0.6 * x[1] + 0.4 * x[3], 0.0, 1e-12);  // nothing pushes the two together
}

}  // namespace
}  // namespace truth
