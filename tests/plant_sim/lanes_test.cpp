// Eight lanes do what eight single runs do.
#include <gtest/gtest.h>

#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

/// Rounding only; the operations are the same.
constexpr double kAgree = 1e-12;

TEST(Lanes, DoArithmeticAndSelectionLaneByLane) {
  Lanes a;
  Lanes b;
  for (std::size_t i = 0; i < Lanes::kSize; ++i) {
    a.set(i, static_cast<double>(i) - 3.5);
    b.set(i, 1.0 + 0.25 * static_cast<double>(i));
  }
  const Lanes mixed =
      select(a < b, a * b, a / b) + sqrt(abs(a)) - exp(-b) + clamp(a, Lanes(-1.0), b);
  for (std::size_t i = 0; i < Lanes::kSize; ++i) {
    const double x = a[i];
    const double y = b[i];
    EXPECT_EQ(mixed[i], (x < y ? x * y : x / y) + std::sqrt(std::fabs(x)) - std::exp(-y) +
                            std::min(std::max(x, -1.0), y));
  }
  EXPECT_TRUE(all(a < Lanes(4.0)));
  EXPECT_FALSE(all(a < b - Lanes(0.5)));
  EXPECT_EQ(widest(a), 3.5);
}

/// Eight random parameter sets on one input that reaches the stops, together and alone.
void expect_agreement(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> spread(0.5, 2.0);
  auto together = std::make_unique<HydraulicActuator<Lanes>>();
  std::array<std::unique_ptr<Actuator>, Lanes::kSize> alone;
  for (std::size_t lane = 0; lane < Lanes::kSize; ++lane) {
    alone[lane] = std::make_unique<Actuator>();
    std::vector<double> values;
    alone[lane]->parameters.visit([&](const ParameterInfo&, double& value) {
      value *= spread(random);
      values.push_back(value);
    });
    std::size_t next = 0;
    together->parameters.visit(
        [&](const ParameterInfo&, Lanes& value) { value.set(lane, values[next++]); });
    alone[lane]->effects.each([&](auto tag, auto& parameters) {
      using Type = typename decltype(tag)::Type;
      parameters.visit([&](const ParameterInfo& info, double& value) {
        // every third lane without effects, so that neutral stands beside active
        value = lane % 3 == 0 ? info.neutral : info.typical * spread(random) * 0.5;
        together->effects.each([&](auto other, auto& many) {
          if (Type::kName != decltype(other)::Type::kName) return;
          many.visit([&](const ParameterInfo& same, Lanes& target) {
            if (std::string(same.name) == info.name) target.set(lane, value);
          });
        });
      });
    });
    alone[lane]->prepare(1e-3);
    alone[lane]->reset();
  }
  together->prepare(1e-3);
  together->reset();
  for (int k = 0; k < 3000; ++k) {
    const double u_V = (k < 1500 ? 3.0 : 10.0) * std::sin(k * 0.004);
    together->step(u_V);
    for (std::size_t lane = 0; lane < Lanes::kSize; ++lane) {
      alone[lane]->step(u_V);
      const auto& one = alone[lane]->state;
      ASSERT_NEAR(together->state.y_m[lane], one.y_m, kAgree)
          << seed << " step " << k << " lane " << lane;
      ASSERT_NEAR(together->state.in_Pa[lane], one.in_Pa, kAgree * 1e7)
          << seed << " step " << k << " lane " << lane;
      ASSERT_NEAR(together->state.v_mps[lane], one.v_mps, kAgree)
          << seed << " step " << k << " lane " << lane;
    }
  }
}

TEST(Lanes, AgreeWithSingleRunsForEightParameterSetsIncludingStopsAndFriction) {
  for (unsigned seed = 1; seed <= 12 && !HasFatalFailure(); ++seed) expect_agreement(seed);
}

}  // namespace
}  // namespace plant_sim::testing
