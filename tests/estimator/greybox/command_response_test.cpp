// Servos, axes and springs of closed form, and what a logger may do to them.
#include "estimator/greybox/command_response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace estimator::greybox {
namespace {

constexpr double kTs = 0.005;
constexpr std::size_t kSamples = 4000;

struct Motion {
  std::vector<double> u, y;

  [[nodiscard]] CommandResponse response() const { return command_response(kTs, u, y, {}); }
};

double multisine(double t_s) {
  double sum = 0.0;
  for (int i = 1; i <= 7; ++i) sum += std::sin(2.0 * M_PI * 0.17 * i * t_s + 1.3 * i * i) / i;
  return sum;
}

/// m y'' + d y' + k y = g u in small steps; without mass a servo. Noise of 2 um.
Motion plant(double mass_kg, double damping, double stiffness, double gain, bool narrow = false) {
  Motion motion;
  std::mt19937 random(5);
  std::normal_distribution<double> noise_m(0.0, 2e-6);
  constexpr int kParts = 50;
  constexpr double kStep_s = kTs / kParts;
  double y = 0.0;
  double v = 0.0;
  for (std::size_t k = 0; k < kSamples; ++k) {
    const double t_s = kTs * static_cast<double>(k);
    const double u = narrow ? std::sin(2.0 * M_PI * 0.7 * t_s) : multisine(t_s);
    motion.u.push_back(u);
    motion.y.push_back(y + noise_m(random));
    for (int i = 0; i < kParts; ++i) {
      if (mass_kg > 0.0) {
        v += kStep_s / mass_kg * (gain * u - damping * v - stiffness * y);
      } else {
        v = (gain * u - stiffness * y) / damping;
      }
      y += kStep_s * v;
    }
  }
  return motion;
}

/// The position `samples` earlier than it was; below 0: later.
Motion shifted(const Motion& motion, int samples) {
  Motion out;
  for (std::size_t k = 200; k + 200 < motion.u.size(); ++k) {
    out.u.push_back(motion.u[k]);
    out.y.push_back(motion.y[static_cast<std::size_t>(static_cast<int>(k) + samples)]);
  }
  return out;
}

Motion turned(Motion motion) {
  for (double& u : motion.u) u = -u;
  return motion;
}

const Motion& servo() {
  static const Motion motion = plant(0.0, 10.0, 0.0, 0.5);
  return motion;
}

TEST(CommandResponse, IsInOrderForServosAxesAndSprings) {
  for (const Motion& motion : {servo(), plant(5.0, 20.0, 0.0, 10.0), plant(5.0, 20.0, 400.0, 10.0),
                               plant(0.0, 10.0, 100.0, 10.0), plant(0.0, 10.0, 10.0, 10.0, true),
                               plant(5.0, 2.0, 900.0, 10.0), plant(0.0, 10.0, 2000.0, 10.0)}) {
    EXPECT_GT(motion.response().correlation, -0.05);
    EXPECT_EQ(motion.response().delay_s, 0.0);
  }
  EXPECT_GT(servo().response().correlation, 0.99);
}

TEST(CommandResponse, SeesATurnedSign) {
  EXPECT_TRUE(turned(servo()).response().against_command());
  EXPECT_FALSE(turned(servo()).response().with_command());
  EXPECT_FALSE(servo().response().against_command());
  // A spring takes no energy on the whole: nothing is said of its sign.
  EXPECT_FALSE(turned(plant(5.0, 20.0, 400.0, 10.0)).response().with_command());
}

/// y'' = u, u = w^2 (r - y) - 2 z w y': a step response of a closed loop with damping ratio z.
Motion closed_loop(double damping_ratio) {
  Motion motion;
  constexpr double kW = 2.0;
  double y = 0.0;
  double v = 0.0;
  for (std::size_t k = 0; k < 2000; ++k) {
    const double u = kW * kW * (1.0 - y) - 2.0 * damping_ratio * kW * v;
    motion.u.push_back(u);
    motion.y.push_back(y);
    y += kTs * v + 0.5 * kTs * kTs * u;
    v += kTs * u;
  }
  return motion;
}

TEST(CommandResponse, AClosedLoopThatSwingsOutIsNotExchanged) {
  for (double ratio = 0.1; ratio < 0.95; ratio += 0.01) {
    EXPECT_FALSE(closed_loop(ratio).response().columns_exchanged()) << ratio;
  }
}

TEST(CommandResponse, SeesExchangedColumns) {
  for (const Motion& motion :
       {servo(), plant(0.2, 10.0, 0.0, 0.5), plant(0.0, 10.0, 0.0, 0.5, true)}) {
    EXPECT_FALSE(motion.response().columns_exchanged());
    EXPECT_FALSE(turned(motion).response().columns_exchanged());
  }
  const Motion exchanged{servo().y, servo().u};
  EXPECT_TRUE(exchanged.response().columns_exchanged());
  EXPECT_FALSE(exchanged.response().against_command());
}

TEST(CommandResponse, SeesThePositionAheadOfItsCommand) {
  for (const int samples : {4, 20, 60}) {
    EXPECT_NEAR(shifted(servo(), samples).response().delay_s, -kTs * samples, 1.01 * kTs);
    EXPECT_NEAR(turned(shifted(servo(), samples)).response().delay_s, -kTs * samples, 1.01 * kTs);
  }
  EXPECT_EQ(shifted(servo(), 1).response().delay_s, 0.0);
}

TEST(CommandResponse, SeesADeadTime) {
  EXPECT_NEAR(shifted(servo(), -30).response().delay_s, 30.0 * kTs, 1.01 * kTs);
  // A valve of 20 ms is none.
  EXPECT_EQ(plant(0.2, 10.0, 0.0, 0.5).response().delay_s, 0.0);
}

TEST(CommandResponse, SaysNothingOfMotionsOfOneFrequency) {
  EXPECT_EQ(shifted(plant(0.0, 10.0, 0.0, 0.5, true), 20).response().delay_s, 0.0);
}

TEST(CommandResponse, TakesTheLongestSegment) {
  Motion motion = servo();
  for (std::size_t k = 0; k < 1000; ++k) motion.u[k] = -motion.u[k];
  EXPECT_GT(command_response(kTs, motion.u, motion.y, {1000}).correlation, 0.99);
}

TEST(CommandResponse, IsEmptyForShortOrMotionlessRecords) {
  EXPECT_EQ(command_response(kTs, {1.0, 2.0}, {0.0, 1.0}, {}).correlation, 0.0);
  const std::vector<double> still(1000, 1.0);
  const CommandResponse response = command_response(kTs, still, still, {});
  EXPECT_EQ(response.correlation, 0.0);
  EXPECT_EQ(response.delay_s, 0.0);
}

}  // namespace
}  // namespace estimator::greybox
