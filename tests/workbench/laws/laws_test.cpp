// Steady motion against closed forms, and the laws that simulated samples show.
#include "workbench/laws/laws.h"

#include <gtest/gtest.h>

#include <cmath>

#include "config/schema/document.h"
#include "estimator/greybox/dataset.h"
#include "workbench/laws/steady_motion.h"

namespace workbench::laws {
namespace {

namespace greybox = estimator::greybox;
namespace validation = estimator::greybox::validation;

plant_sim::ModelFile model_of(const std::string& text) {
  return plant_sim::read_model(config::schema::Document::parse(text, "model.toml"));
}

const std::string kAxis = R"(schema_version = 1
name = "axis"
plant = "force_driven_axis"
[parameters]
mass_kg = 10
damping_N_s_per_m = 100
gain_N_per_V = 50
)";
const std::string kFriction = "[effects.friction]\ncoulomb_N = 80\n";

// The simulation ends within a thousandth of the steady speed.
constexpr double kSteady = 2e-3;

TEST(SteadyMotion, OfAnAxisIsDampingAndFriction) {
  const SteadyMotion motion =
      steady_motion(model_of(kAxis + kFriction), {-4.0, -1.0, 1.0, 2.0, 4.0});
  // v = (gain u -+ Fc) / d beyond friction
  EXPECT_NEAR(motion.speed_mps[0], -1.2, 1.2 * kSteady);
  EXPECT_NEAR(motion.speed_mps[1], 0.0, 1e-9);
  EXPECT_NEAR(motion.speed_mps[2], 0.0, 1e-9);
  EXPECT_NEAR(motion.speed_mps[3], 0.2, 0.2 * kSteady);
  EXPECT_NEAR(motion.speed_mps[4], 1.2, 1.2 * kSteady);
  EXPECT_EQ(motion.force_N[4], 200.0);
}

TEST(SteadyMotion, OfAServoIsItsGainAndDeadBandAndHasNoForce) {
  const plant_sim::ModelFile model = model_of(R"(schema_version = 1
name = "servo"
plant = "velocity_servo"
[parameters]
gain_mps_per_V = 0.1
time_constant_s = 0.02
[effects.deadband]
half_width_V = 0.5
)");
  std::vector<double> commands;
  for (int i = -10; i <= 10; ++i) commands.push_back(0.3 * i);
  const SteadyMotion motion = steady_motion(model, commands);
  ASSERT_EQ(motion.speed_mps.size(), commands.size());
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const double beyond_V = std::max(0.0, std::abs(commands[i]) - 0.5);
    EXPECT_NEAR(motion.speed_mps[i], std::copysign(0.1 * beyond_V, commands[i]),
                1e-3 * kSteady + 3e-4)
        << commands[i];
    EXPECT_TRUE(std::isnan(motion.force_N[i]));
  }
}

TEST(SteadyMotion, OfACylinderMovesWithoutAnEnd) {
  const plant_sim::ModelFile model =
      plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/thesis.toml");
  const SteadyMotion motion = steady_motion(model, {-5.0, 0.0, 5.0});
  EXPECT_LT(motion.speed_mps[0], 0.0);
  EXPECT_NEAR(motion.speed_mps[1], 0.0, 1e-6);
  EXPECT_NEAR(motion.speed_mps[2], -motion.speed_mps[0], kSteady * motion.speed_mps[2]);
  // Chambers hold what the damping takes.
  plant_sim::ModelFile copy = model;
  const double damping = *copy.value("damping_N_s_per_m");
  EXPECT_NEAR(motion.force_N[2], damping * motion.speed_mps[2],
              0.02 * std::abs(damping * motion.speed_mps[2]) + 1.0);
}

/// The axis with friction under a sum of sines, integrated by hand with a small step.
validation::Comparison compared(const plant_sim::ModelFile& with) {
  greybox::Dataset record;
  record.name = "by hand";
  record.sample_time_s = 0.005;
  record.starts = {0};
  double y_m = 0.3;
  double v_mps = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const double t_s = 0.005 * k;
    const double u_V = 6.0 * std::sin(2.0 * t_s) + 2.0 * std::sin(5.3 * t_s);
    record.t_s.push_back(t_s);
    record.u_V.push_back(u_V);
    record.y_m.push_back(y_m);
    for (int i = 0; i < 100; ++i) {
      const double drive_N = 50.0 * u_V - 100.0 * v_mps;
      const bool sticks = std::abs(v_mps) < 1e-3 && std::abs(drive_N) < 80.0;
      v_mps = sticks
                  ? 0.0
                  : v_mps + 5e-5 * (drive_N - std::copysign(80.0, v_mps == 0.0 ? drive_N : v_mps)) /
                                10.0;
      y_m += 5e-5 * v_mps;
    }
  }
  record.valid.assign(record.t_s.size(), char{1});
  return validation::compare(with, record);
}

TEST(Laws, TheSamplesShowTheFrictionThatAModelLacks) {
  const plant_sim::ModelFile lacks = model_of(kAxis);
  const std::vector<Law> laws = laws_of(lacks, compared(lacks));
  ASSERT_EQ(laws.size(), 1U);
  const Law& law = laws.front();
  EXPECT_EQ(law.title, "Resisting force over speed");
  EXPECT_EQ(law.y_unit, "N");
  EXPECT_LE(law.samples.x.size(), 1500U);
  int fast = 0;
  for (std::size_t i = 0; i < law.mean.x.size(); ++i) {
    const double v_mps = 1e-3 * law.mean.x[i];
    if (std::abs(v_mps) < 0.5) continue;
    ++fast;
    // 50 ms of smoothing to either side at reversals of the acceleration
    EXPECT_NEAR(law.mean.y[i], 100.0 * v_mps + std::copysign(80.0, v_mps), 10.0) << v_mps;
  }
  EXPECT_GT(fast, 10);
  // The model's own law lies lower by its missing friction.
  for (std::size_t i = 0; i < law.model.x.size(); ++i) {
    EXPECT_NEAR(law.model.y[i], 0.1 * law.model.x[i], 2e-3 * std::abs(law.model.y[i]) + 0.2);
  }
}

}  // namespace
}  // namespace workbench::laws
