// Eight lanes do what eight single runs do.
#include <gtest/gtest.h>

#include "tests/plant_sim/support.h"

namespace plant_sim::testing {
namespace {

/// Rounding only; the operations are the same.
constexpr double kAgree = 1e-12;

TEST(SimdVector, DoArithmeticAndSelectionLaneByLane) {
  Simd a;
  Simd b;
  for (std::size_t i = 0; i < Simd::kSize; ++i) {
    a.set(i, static_cast<double>(i) - 3.5);
    b.set(i, 1.0 + 0.25 * static_cast<double>(i));
  }
  const Simd mixed = select(a < b, a * b, a / b) + sqrt(abs(a)) - exp(-b) + clamp(a, Simd(-1.0), b);
  for (std::size_t i = 0; i < Simd::kSize; ++i) {
    const double x = a[i];
    const double y = b[i];
    EXPECT_EQ(mixed[i], (x < y ? x * y : x / y) + std::sqrt(std::fabs(x)) - std::exp(-y) +
                            std::min(std::max(x, -1.0), y));
  }
  EXPECT_TRUE(all(a < Simd(4.0)));
  EXPECT_FALSE(all(a < b - Simd(0.5)));
  EXPECT_EQ(reduce_max(a), 3.5);
}

/// Rounding of a state, by the size that its unit usually has.
double allowed(const std::string& name) { return name.ends_with("_Pa") ? kAgree * 1e7 : kAgree; }

template <class State>
auto values_of(State state) {
  std::vector<std::pair<std::string, std::decay_t<decltype(state.y_m)>>> values;
  state.visit([&](const char* name, const auto& value) { values.emplace_back(name, value); });
  return values;
}

/// Eight random parameter sets on one input that reaches the stops, together and alone.
template <template <class> class Plant>
void expect_agreement(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> spread(0.5, 2.0);
  auto together = std::make_unique<Plant<Simd>>();
  std::array<std::unique_ptr<Plant<double>>, Simd::kSize> alone;
  for (std::size_t lane = 0; lane < Simd::kSize; ++lane) {
    alone[lane] = std::make_unique<Plant<double>>();
    std::vector<double> values;
    alone[lane]->parameters.visit([&](const ParameterInfo& info, double& value) {
      value = info.typical * spread(random);
      values.push_back(value);
    });
    std::size_t next = 0;
    together->parameters.visit(
        [&](const ParameterInfo&, Simd& value) { value.set(lane, values[next++]); });
    std::vector<double> of_effects;
    alone[lane]->effects.each([&](auto tag, auto& parameters) {
      using Effect = typename decltype(tag)::Type;
      constexpr bool kFits = effects::fits<Effect, Plant<double>>();
      // one of three without, so that neutral stands beside active
      const bool present = kFits && lane % 3 != 0 && spread(random) < 1.5;
      parameters.visit([&](const ParameterInfo& info, double& value) {
        value = present ? info.typical * spread(random) * 0.5 : info.neutral;
        of_effects.push_back(value);
      });
    });
    next = 0;
    together->effects.each([&](auto, auto& parameters) {
      parameters.visit(
          [&](const ParameterInfo&, Simd& value) { value.set(lane, of_effects[next++]); });
    });
    alone[lane]->prepare(1e-3);
    alone[lane]->reset();
  }
  together->prepare(1e-3);
  together->reset();
  for (int k = 0; k < 3000; ++k) {
    const double u_V = (k < 1500 ? 3.0 : 10.0) * std::sin(k * 0.004);
    together->step(u_V);
    const auto many = values_of(together->state);
    const Simd reading_m = together->effects.reading_m(together->state.y_m);
    for (std::size_t lane = 0; lane < Simd::kSize; ++lane) {
      alone[lane]->step(u_V);
      const auto one = values_of(alone[lane]->state);
      for (std::size_t i = 0; i < one.size(); ++i) {
        ASSERT_NEAR(many[i].second[lane], one[i].second, allowed(one[i].first))
            << seed << " step " << k << " lane " << lane << " " << one[i].first;
      }
      ASSERT_NEAR(reading_m[lane], alone[lane]->effects.reading_m(alone[lane]->state.y_m), kAgree);
    }
  }
}

TEST(SimdVector, AgreeWithSingleRunsForEightActuatorsWithEffectsIncludingStops) {
  for (unsigned seed = 1; seed <= 12 && !HasFatalFailure(); ++seed) {
    expect_agreement<HydraulicActuator>(seed);
  }
}

TEST(SimdVector, AgreeWithSingleRunsForEightCylindersOfTwoAreas) {
  for (unsigned seed = 1; seed <= 12 && !HasFatalFailure(); ++seed) {
    expect_agreement<HydraulicCylinder>(seed);
  }
}

TEST(SimdVector, AgreeWithSingleRunsForEightServosAndEightAxes) {
  for (unsigned seed = 1; seed <= 6 && !HasFatalFailure(); ++seed) {
    expect_agreement<VelocityServo>(seed);
    expect_agreement<ForceDrivenAxis>(seed);
  }
}

}  // namespace
}  // namespace plant_sim::testing
