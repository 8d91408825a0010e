// A file's value that is farther off than its prior's range allows is no missing effect.
#include "estimator/greybox/selection/file_values.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::context_of;
using testing::ElementsAre;

constexpr const char* kGain = "valve_gain_m_per_V";

FreeParameter& parameter(DiagnosisProblem& problem, const std::string& name) {
  auto& all = problem.plant_parameters;
  return *std::find_if(all.begin(), all.end(), [&](const auto& p) { return p.name == name; });
}

/// A model at the file's values but for the gain, `sds` away.
ModelStage with_gain_off(const DiagnosisProblem& problem, double sds) {
  ModelStage stage;
  stage.fitted.parameters = problem.plant_parameters;
  stage.fitted.theta = start_of(problem.model, problem.plant_parameters);
  for (std::size_t i = 0; i < problem.plant_parameters.size(); ++i) {
    const FreeParameter& p = problem.plant_parameters[i];
    if (p.name == kGain) stage.fitted.theta[static_cast<Eigen::Index>(i)] = sds * p.prior_sd;
  }
  return stage;
}

TEST(FileValues, OnlyTheStrainedOneIsWidened) {
  DiagnosisProblem problem = context_of("motion=multisine,length_s=2").problem;
  const double upper = parameter(problem, kGain).upper;
  const double others = parameter(problem, "supply_pressure_Pa").upper;
  EXPECT_FALSE(widen_strained(with_gain_off(problem, 2.9), problem));
  EXPECT_EQ(parameter(problem, kGain).upper, upper);
  EXPECT_TRUE(widen_strained(with_gain_off(problem, 3.0), problem));
  EXPECT_NEAR(parameter(problem, kGain).upper, 2.0 * upper, 1e-12);
  EXPECT_EQ(parameter(problem, "supply_pressure_Pa").upper, others);
}

TEST(FileValues, AnEndThatTheUserSetStays) {
  DiagnosisProblem problem = context_of("motion=multisine,length_s=2").problem;
  FreeParameter& gain = parameter(problem, kGain);
  const double lower = gain.lower;
  gain.upper = 0.5 * gain.prior_sd;
  EXPECT_FALSE(widen_strained(with_gain_off(problem, 0.5), problem));
  EXPECT_EQ(gain.upper, 0.5 * gain.prior_sd);
  EXPECT_TRUE(widen_strained(with_gain_off(problem, -3.0), problem));
  EXPECT_EQ(gain.upper, 0.5 * gain.prior_sd);
  EXPECT_NEAR(gain.lower, 2.0 * lower, 1e-12);
}

TEST(LongFileValues, AGainFarOffIsNoEffectBesideADeadBand) {
  constexpr double kDataSheet = 0.1;
  constexpr double kOff_sds = -4.0;
  DiagnosisProblem nominal = context_of("motion=multisine,length_s=2").problem;
  const double true_gain = parameter(nominal, kGain).to_physical(kOff_sds * kDataSheet);
  SearchContext context = context_of(fmt::format(
      "motion=multisine,length_s=20,deadband.half_width_V=0.1,plant.{}={}", kGain, true_gain));
  FreeParameter& gain = parameter(context.problem, kGain);
  gain.prior_sd = kDataSheet;
  gain.upper = 3.0 * kDataSheet;
  gain.lower = -gain.upper;
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.missing, ElementsAre("deadband"));
  const auto found = std::find_if(d.parameters.begin(), d.parameters.end(),
                                  [](const ParameterValue& p) { return p.name == kGain; });
  ASSERT_NE(found, d.parameters.end());
  EXPECT_NEAR(found->value / true_gain, 1.0, 0.02);
  EXPECT_NEAR(found->prior_sds, kOff_sds, 0.2);
}

}  // namespace
}  // namespace estimator::greybox::selection
