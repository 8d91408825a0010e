// A file's value that is farther off than its prior's range allows is no missing effect.
#include "estimator/greybox/selection/file_values.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/other_file_values.h"
#include "tests/estimator/greybox/selection/servo_problem.h"
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

/// The truth generator's single rod in the product's words, its supply known to 3 %.
DiagnosisProblem single_rod(const std::string& spec) {
  plant_sim::ModelFile model = diagnose_test::single_rod();
  *model.value("damping_N_s_per_m") = 3000.0;
  const truth::Record truth = truth::simulate(truth::parse_case(spec, 41));
  DiagnosisProblem problem =
      make_problem(model, fit_dataset({diagnose_test::dataset_of(truth)}, {}));
  FreeParameter& supply = parameter(problem, "supply_pressure_Pa");
  supply.prior_sd = 0.03;
  supply.upper = 3.0 * supply.prior_sd;
  supply.lower = -supply.upper;
  return problem;
}

/// The outcome of prefer_other_file_values for an effect that explains a servo's record, where the
/// file's gain, known to 3 %, is `share` of it too large.
struct GivenUp {
  bool preferred = false;
  SearchStart start;
};
GivenUp gain_off_by(double share) {
  SearchContext context =
      diagnose_test::servo_context({.rate_mps = diagnose_test::with_offset(0.0), .samples = 2400});
  const double file_mps_per_V = diagnose_test::kServoGain / (1.0 - share);
  *context.problem.model.value("gain_mps_per_V") = file_mps_per_V;
  SearchContext free = context;
  for (DiagnosisProblem* problem : {&context.problem, &free.problem}) {
    FreeParameter& gain = parameter(*problem, "gain_mps_per_V");
    gain.unit = file_mps_per_V;
    gain.prior_sd = problem == &context.problem ? 0.03 : INFINITY;
    gain.upper = problem == &context.problem ? 3.0 * gain.prior_sd : 1.0;
    gain.lower = -gain.upper;
  }
  GivenUp result{false, start_search(context)};
  EXPECT_FALSE(is_explained(context, result.start.first));
  result.start.branch.stage = first_stage(free);
  result.start.branch.stage.added = {"deadband"};  // in the place of any effect that explains it
  DiagnosisProblem problem = context.problem;
  result.preferred = prefer_other_file_values(context, result.start, problem);
  return result;
}

TEST(FileValues, AGainFarBelowTheFileMakesEffectsSuperfluous) {
  const GivenUp far = gain_off_by(0.15);  // 5.4 standard deviations
  ASSERT_TRUE(far.preferred);
  EXPECT_THAT(far.start.branch.stage.added, testing::IsEmpty());
  EXPECT_NEAR(far.start.first.fitted.value("gain_mps_per_V"), diagnose_test::kServoGain, 1e-4);
  // 7.4 standard deviations cost more than the evidence that an effect needs
  EXPECT_FALSE(gain_off_by(0.2).preferred);
}

TEST(FileValues, AForceIsNotTakenForASupplyFarBelowTheFile) {
  const DiagnosisProblem problem =
      single_rod("rig=single_rod,motion=multisine,length_s=20,load_force.force_N=400");
  const Diagnosis d = diagnose(problem, {});
  EXPECT_EQ(d.verdict, Verdict::missing);
  EXPECT_THAT(d.missing, ElementsAre("load_force"));
  EXPECT_NEAR(d.final.value("load_force.force_N"), 400.0, 40.0);
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
