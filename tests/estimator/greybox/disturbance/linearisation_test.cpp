#include "estimator/greybox/disturbance/linearisation.h"

#include <gmock/gmock.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "estimator/greybox/observer_simulation.h"
#include "tests/estimator/greybox/disturbance/axis_record.h"

namespace estimator::greybox::disturbance {
namespace {

using disturbance_test::axis;
using disturbance_test::axis_record;
using disturbance_test::kTs_s;

// M v' = -d v - F over one sample, y' = v, solved exactly.
TEST(Linearisation, OfAnAxisIsTheExactTransitionOverASample) {
  plant_sim::ModelFile model = axis();
  const double mass_kg = *model.value("mass_kg");
  const double damping_N_s_per_m = *model.value("damping_N_s_per_m");
  const Linearisation linear = linearise(model, axis_record(), {}, Eigen::VectorXd());
  ASSERT_THAT(linear.states, testing::ElementsAre("y_m", "v_mps"));
  EXPECT_TRUE(linear.force);
  EXPECT_FALSE(linear.supply);
  const double a_per_s = damping_N_s_per_m / mass_kg;
  const double decay = std::exp(-a_per_s * kTs_s);
  const double travel_s = (1.0 - decay) / a_per_s;
  for (const std::size_t k : {0U, 100U, 799U}) {
    const StateMatrix& a = linear.transition[k];
    EXPECT_NEAR(a(0, 0), 1.0, 1e-8);
    EXPECT_NEAR(a(0, 1), travel_s, 1e-7);
    EXPECT_NEAR(a(1, 0), 0.0, 1e-6);
    EXPECT_NEAR(a(1, 1), decay, 1e-7);
    EXPECT_NEAR(a(0, kMostStates - 1), -(kTs_s - travel_s) / damping_N_s_per_m, 1e-10);
    EXPECT_NEAR(a(1, kMostStates - 1), -(1.0 - decay) / damping_N_s_per_m, 1e-8);
  }
}

plant_sim::ModelFile with_second_mass(plant_sim::ModelFile model, double ratio, double place) {
  *model.value("second_mass.mass_ratio") = ratio;
  *model.value("second_mass.resonance_Hz") = 17.0;
  *model.value("second_mass.damping_ratio") = 0.03;
  *model.value("second_mass.sensor_ratio") = place;
  for (auto& effect : model.effects) effect.present = effect.name == "second_mass";
  return model;
}

/// exp(A) by scaling and squaring of its series.
Eigen::MatrixXd exponential(const Eigen::MatrixXd& a) {
  const Eigen::MatrixXd small = a / 1024.0;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Identity(a.rows(), a.cols());
  Eigen::MatrixXd term = sum;
  for (int i = 1; i <= 16; ++i) {
    term = (term * small / i).eval();
    sum += term;
  }
  for (int i = 0; i < 10; ++i) sum = (sum * sum).eval();
  return sum;
}

// Two bodies M1, M2 with a spring and a damper between them, the force F on the one that carries
// the sensor; by matrix exponential in the coordinates s = x1 + b (x2 - x1), x1', x2 - x1, its
// rate.
TEST(Linearisation, OfAnAxisWithASecondMassIsThatOfTwoBodies) {
  constexpr double kRatio = 0.4;
  const Eigen::Vector4d unit(kTs_s, 1.0, kTs_s,
                             1.0);  // a speed moves a position so far in a sample
  const double w = 2.0 * std::numbers::pi * 17.0;
  for (const double place : {0.0, 0.5, 1.0}) {
    plant_sim::ModelFile model = with_second_mass(axis(), kRatio, place);
    const double m1_kg = (1.0 - kRatio) * *model.value("mass_kg");
    const double m2_kg = kRatio * *model.value("mass_kg");
    const double reduced_kg = m1_kg * m2_kg / (m1_kg + m2_kg);
    const double k = reduced_kg * w * w;
    const double c = reduced_kg * 2.0 * 0.03 * w;
    const double d = *model.value("damping_N_s_per_m");
    Eigen::MatrixXd bodies = Eigen::MatrixXd::Zero(5, 5);  // x1, x1', x2, x2', F
    bodies(0, 1) = 1.0;
    bodies.row(1) << -k / m1_kg, -(c + d) / m1_kg, k / m1_kg, c / m1_kg, -(1.0 - place) / m1_kg;
    bodies(2, 3) = 1.0;
    bodies.row(3) << k / m2_kg, c / m2_kg, -k / m2_kg, -c / m2_kg, -place / m2_kg;
    Eigen::MatrixXd to(5, 5);                 // s, x1', z, z', F
    to << 1.0 - place, 0.0, place, 0.0, 0.0,  //
        0.0, 1.0, 0.0, 0.0, 0.0,              //
        -1.0, 0.0, 1.0, 0.0, 0.0,             //
        0.0, -1.0, 0.0, 1.0, 0.0,             //
        0.0, 0.0, 0.0, 0.0, 1.0;
    const Eigen::MatrixXd truth = to * exponential(bodies * kTs_s) * to.inverse();
    const Linearisation linear = linearise(model, axis_record(), {}, Eigen::VectorXd());
    ASSERT_THAT(linear.states, testing::ElementsAre("y_m", "v_mps", "second_mass.offset_m",
                                                    "second_mass.offset_mps"));
    for (const std::size_t at : {0U, 500U}) {
      const StateMatrix& a = linear.transition[at];
      for (Eigen::Index i = 0; i < 4; ++i) {
        for (Eigen::Index j = 0; j < 4; ++j) {
          EXPECT_NEAR(a(i, j), truth(i, j),
                      1e-3 * std::max(std::abs(truth(i, j)), unit[i] / unit[j]))
              << i << j << place;
        }
        EXPECT_NEAR(a(i, kMostStates - 1), truth(i, 4), 1e-3 * truth.col(4).cwiseAbs()[i] + 1e-10)
            << i << place;
      }
    }
  }
}

// A correction of the offset alone leaves the reading, and shows one sample later as A's column
// says.
TEST(Linearisation, AnOffsetIsCorrectedWithTheReadingHeld) {
  constexpr double kGain = 0.2;
  constexpr Eigen::Index kAt = 30;
  const plant_sim::ModelFile model = with_second_mass(axis(), 0.4, 0.5);
  Dataset record = axis_record(60);
  record.y_m[kAt] += 1e-4;
  const Linearisation linear = linearise(model, record, {}, Eigen::VectorXd());
  const auto innovations = [&](double gain) {
    InnovationGains gains;
    gains.states = linear.states;
    gains.gain = Eigen::MatrixXd::Zero(5, static_cast<Eigen::Index>(record.size()));
    gains.gain(2, kAt) = gain;
    gains.scale = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(record.size()));
    record.innovations = std::make_shared<const InnovationGains>(gains);
    ObserverSimulation run(model, record, {});
    Eigen::MatrixXd residuals_m;
    run.residuals(Eigen::VectorXd(), residuals_m);
    return Eigen::VectorXd(residuals_m.col(0));
  };
  const Eigen::VectorXd without_m = innovations(0.0);
  const Eigen::VectorXd with_m = innovations(kGain);
  EXPECT_EQ(with_m[kAt], without_m[kAt]);
  const double moved_m = kGain * without_m[kAt];  // the offset
  const double expected_m = -linear.transition[kAt](0, 2) * moved_m;
  ASSERT_GT(std::abs(expected_m), 1e-3 * std::abs(moved_m));
  EXPECT_NEAR(with_m[kAt + 1] - without_m[kAt + 1], expected_m, 1e-3 * std::abs(expected_m));
}

// More states than an ensemble has lanes for. What hangs on a cylinder's rod moves it as little as
// it weighs.
TEST(Linearisation, OfACylinderWithASmallSecondMassIsThatOfTheCylinder) {
  const plant_sim::ModelFile rigid =
      plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/rig_2000psi.toml");
  Dataset record = axis_record(50);
  for (double& y_m : record.y_m) y_m += 0.3;
  const Linearisation plain = linearise(rigid, record, {}, Eigen::VectorXd());
  const Linearisation hung =
      linearise(with_second_mass(rigid, 1e-7, 0.0), record, {}, Eigen::VectorXd());
  ASSERT_THAT(hung.states, testing::SizeIs(plain.states.size() + 2));
  for (const std::size_t at : {0U, 40U}) {
    // the spring shortens the steps, and with them the error of integration
    constexpr double kStep_ratio = 0.03;
    const Eigen::Vector4d unit(1e-6, 1e-5, 1e3, 1e3);
    const auto n = static_cast<Eigen::Index>(plain.states.size());
    ASSERT_EQ(n, unit.size());
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto expect_near = [&](double found, double expected, double input) {
        EXPECT_NEAR(found, expected, kStep_ratio * std::abs(expected) + 1e-3 * unit[i] / input)
            << i << " by " << input;
      };
      for (Eigen::Index j = 0; j < n; ++j) {
        expect_near(hung.transition[at](i, j), plain.transition[at](i, j), unit[j]);
      }
      expect_near(hung.transition[at](i, kMostStates - 1), plain.transition[at](i, kMostStates - 1),
                  1.0);
      expect_near(hung.from_supply[at][i], plain.from_supply[at][i], 1e3);
    }
    // the mass swings as if its carrier were held
    const double w = 2.0 * std::numbers::pi * 17.0;
    const double wd = w * std::sqrt(1.0 - 0.03 * 0.03);
    const double decay = std::exp(-0.03 * w * kTs_s);
    EXPECT_NEAR(hung.transition[at](n, n + 1), decay * std::sin(wd * kTs_s) / wd, 1e-5);
  }
}

TEST(Linearisation, LeavesDryFrictionOutOfTheSlopes) {
  plant_sim::ModelFile rough = axis();
  *rough.value("friction.coulomb_N") = 50.0;
  *rough.value("friction.static_N") = 80.0;
  *rough.value("friction.stribeck_mps") = 0.01;
  for (auto& effect : rough.effects) effect.present = effect.name == "friction";
  const Linearisation with = linearise(rough, axis_record(), {}, Eigen::VectorXd());
  const Linearisation without = linearise(axis(), axis_record(), {}, Eigen::VectorXd());
  for (const std::size_t k : {0U, 400U}) {
    EXPECT_NEAR((with.transition[k] - without.transition[k]).norm(), 0.0, 1e-6);
  }
}

// The model's own readings, without noise: they rest while the gap is open.
TEST(Linearisation, AGapIsOpenWhileTheReadingRests) {
  plant_sim::ModelFile model = axis();
  *model.value("backlash.width_m") = 3e-4;
  for (auto& effect : model.effects) effect.present = effect.name == "backlash";
  Dataset record = axis_record();
  EXPECT_THAT(linearise(model, record, {}, Eigen::VectorXd()).gap_m, testing::IsEmpty());
  record.valid.assign(record.size(), 0);
  ObserverSimulation run(model, record, {}, 0.0);
  Eigen::MatrixXd residuals_m;
  run.residuals(Eigen::VectorXd(), residuals_m);
  record.y_m = run.predicted().reading_m;
  record.valid.assign(record.size(), 1);
  InnovationGains gains;
  gains.states = {"y_m", "v_mps"};
  gains.gain = Eigen::MatrixXd::Zero(3, static_cast<Eigen::Index>(record.size()));
  gains.scale = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(record.size()));
  record.innovations = std::make_shared<const InnovationGains>(gains);
  const Linearisation linear = linearise(model, record, {}, Eigen::VectorXd());
  ASSERT_EQ(linear.gap_m.size(), record.size());
  int open = 0;
  for (std::size_t k = 2; k < record.size(); ++k) {
    const double moved_m = std::abs(record.y_m[k] - record.y_m[k - 1]);
    if (linear.gap_m[k] > 1e-9) {
      EXPECT_LT(moved_m, 1e-12) << k;
      ++open;
    } else if (linear.gap_m[k] < -1e-9) {
      EXPECT_GT(moved_m, 0.0) << k;
    }
  }
  EXPECT_GT(open, 20);
}

}  // namespace
}  // namespace estimator::greybox::disturbance
