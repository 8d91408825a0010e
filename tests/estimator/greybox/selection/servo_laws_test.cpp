// A bought drive adds to a servo ramps, gains that saturate, and loops that yield to a load.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "estimator/greybox/selection/confidence.h"
#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/learned_laws.h"
#include "tests/estimator/greybox/selection/servo_problem.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::kServoGain;
using diagnose_test::servo_context;
using testing::ElementsAre;

Diagnosis diagnosed(const diagnose_test::ServoRun& run) {
  const SearchContext context = servo_context(run);
  return diagnose(context.problem, {});
}

double value(const Diagnosis& d, const std::string& name) { return d.final.value(name); }

// A valve of 10.6 Hz whose damping ratio is 0.6, against a file with a lag of first order.
TEST(ServoLaws, ASpeedThatOvershootsIsALagOfSecondOrder) {
  constexpr double kNatural_per_s = 66.7;
  constexpr double kDamping_ratio = 0.6;
  double speed_mps = 0.0;
  double rate_mps2 = 0.0;
  const diagnose_test::ServoRun run{.rate_mps =
                                        [&](double u_V, double, double) {
                                          rate_mps2 +=
                                              1e-4 * kNatural_per_s *
                                              (kNatural_per_s * (kServoGain * u_V - speed_mps) -
                                               2.0 * kDamping_ratio * rate_mps2);
                                          return speed_mps += 1e-4 * rate_mps2;
                                        },
                                    .samples = 2400};
  plant_sim::ModelFile model = diagnose_test::servo_model();
  *model.value("time_constant_s") = 0.01;
  const Diagnosis d =
      diagnose(make_problem(model, fit_dataset({diagnose_test::servo_record(run)}, {})), {});
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.missing, ElementsAre("second_order_lag"));
  EXPECT_LT(d.rms_after_m, 1.1 * d.noise_floor_m);
  // the record's own integration moves its poles by half a step of 0.1 ms
  EXPECT_NEAR(value(d, "second_order_lag.inertia_ratio"),
              1.0 / (4.0 * kDamping_ratio * kDamping_ratio), 0.01);
}

TEST(ServoLaws, ARampOfTheSpeedIsNamedWithItsLimit) {
  constexpr double kLimit_mps2 = 0.35;
  double speed_mps = 0.0;
  const Diagnosis d = diagnosed({.rate_mps =
                                     [&](double u_V, double, double) {
                                       const double most_mps = kLimit_mps2 * 1e-4;
                                       const double gap_mps = kServoGain * u_V - speed_mps;
                                       speed_mps += std::clamp(gap_mps, -most_mps, most_mps);
                                       return speed_mps;
                                     },
                                 .samples = 2400});
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.missing, ElementsAre("acceleration_limit"));
  EXPECT_NEAR(value(d, "acceleration_limit.limit_mps2"), kLimit_mps2, 0.01 * kLimit_mps2);
}

TEST(ServoLaws, AGainThatSaturatesIsAFormula) {
  constexpr double kFull_V = 1.2;
  const Diagnosis d =
      diagnosed({.rate_mps = [](double u_V, double,
                                double) { return kServoGain * kFull_V * std::tanh(u_V / kFull_V); },
                 .samples = 2400});
  EXPECT_EQ(d.verdict, Verdict::learned);
  EXPECT_THAT(d.missing, ElementsAre("tanh_saturation"));
  EXPECT_NEAR(value(d, "gain_mps_per_V"), kServoGain, 1e-3 * kServoGain);
}

TEST(ServoLaws, AGainThatSaturatesAsARootIsAnotherFormula) {
  constexpr double kFull_V = 1.2;
  const Diagnosis d =
      diagnosed({.rate_mps =
                     [](double u_V, double, double) {
                       return kServoGain * u_V / std::sqrt(1.0 + std::pow(u_V / kFull_V, 2));
                     },
                 .samples = 2400});
  EXPECT_EQ(d.verdict, Verdict::learned);
  EXPECT_THAT(d.missing, ElementsAre("root_saturation"));
  EXPECT_NEAR(value(d, "gain_mps_per_V"), kServoGain, 1e-3 * kServoGain);
}

TEST(ServoLaws, ASpringToWhichTheServoYieldsIsAFormula) {
  constexpr double kRate_per_s = 0.4;
  constexpr double kRest_m = 0.27;
  const Diagnosis d = diagnosed(
      {.rate_mps = [](double u_V, double y_m,
                      double) { return kServoGain * u_V - kRate_per_s * (y_m - kRest_m); },
       .samples = 2400});
  EXPECT_EQ(d.verdict, Verdict::learned);
  EXPECT_THAT(d.missing, ElementsAre("spring_speed"));
  EXPECT_NEAR(value(d, "spring_speed.rate_per_s"), kRate_per_s, 0.02 * kRate_per_s);
  EXPECT_NEAR(value(d, "spring_speed.rest_m"), kRest_m, 1e-3);
}

TEST(ServoLaws, ALawThatComesNearIsInTheBetterModelAndNoVerdict) {
  // a weight on an arm, which the integrator of a speed loop takes back in time
  constexpr double kYields_mps = 0.02;
  constexpr double kTakesBack_s = 8.0;
  double taken_mps = 0.0;
  const SearchContext context =
      servo_context({.rate_mps =
                         [&](double u_V, double y_m, double) {
                           const double yields_mps = kYields_mps * std::sin((y_m - 0.3) / 0.04);
                           taken_mps += 1e-4 / kTakesBack_s * (yields_mps - taken_mps);
                           return kServoGain * u_V + yields_mps - taken_mps;
                         },
                     .samples = 2400});
  const ModelStage first = first_stage(context);
  const std::optional<LawSearch> found =
      search_laws(context, first, "", {}, LawChoice::unexplained, kMostInnovationEffects);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->explains_record());
  Diagnosis d;
  d.verdict = Verdict::unexplained;
  d.noise_floor_m = context.problem.data.noise_floor_m;
  d.search.final = first;
  d.rms_after_m = first.fitted.validation_rms_m;
  approximate_by_laws(context, first, *found, d);
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  ASSERT_FALSE(d.laws.empty());
  EXPECT_LT(d.rms_after_m, 0.5 * first.fitted.validation_rms_m);
  weigh_doubts(d);
  for (const Law& law : d.laws) {
    EXPECT_NE(d.better.value(law.effect.name + "." + law.effect.parameters.front().name), nullptr);
    EXPECT_THAT(d.possible,
                testing::Contains(testing::Field(&PossibleEffect::effect, law.effect.name)));
  }
}

}  // namespace
}  // namespace estimator::greybox::selection
