// Records of the independent simulator whose logged position has more than white noise.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::context_with;

Diagnosis diagnosis_of(const truth::Record& record) {
  const SearchContext context = context_with(diagnose_test::dataset_of(record));
  return diagnose(context.problem, context.options);
}

// All pressures, forces and masses scale together: the record tells nothing about the supply
// pressure, whose error is the prior's.
TEST(ReadingNoise, AHumLeavesErrorsThatContainTheRig) {
  const std::map<std::string, double> rig = {{"mass_kg", 52.0},
                                             {"damping_N_s_per_m", 1100.0},
                                             {"bulk_modulus_Pa", 6.5e8},
                                             {"supply_pressure_Pa", 6.6e6}};
  std::string spec = "motion=multisine,length_s=20";
  for (const auto& [name, value] : rig) spec += ",plant." + name + "=" + std::to_string(value);
  truth::Record record = truth::simulate(truth::parse_case(spec, 81));
  for (std::size_t k = 0; k < record.y_m.size(); ++k) {
    record.y_m[k] += 2e-5 * std::sin(2.0 * std::numbers::pi * 50.0 * record.t_s[k] + 0.3);
  }
  const Diagnosis d = diagnosis_of(record);
  EXPECT_EQ(d.verdict, Verdict::nothing_missing);
  ASSERT_TRUE(d.disturbance.has_value());
  ASSERT_EQ(d.disturbance->lines.size(), 1U);
  EXPECT_NEAR(d.disturbance->lines.front().amplitude, 2e-5, 0.05 * 2e-5);
  for (const ParameterValue& found : d.parameters) {
    const auto truth = rig.find(found.name);
    if (truth == rig.end()) continue;
    EXPECT_LT(std::abs(found.value - truth->second), 3.0 * found.std_error) << found.name;
    EXPECT_EQ(found.held_by_prior(), found.name == "supply_pressure_Pa") << found.name;
  }
}

TEST(LongReadingNoise, AReadingThatWandersIsNoMissingEffect) {
  truth::Record record = truth::simulate(truth::parse_case("motion=multisine,length_s=20", 82));
  constexpr double kWalk_m = 1.5e-6;
  std::mt19937 random(83);
  std::normal_distribution<double> step_m(0.0, kWalk_m);
  double off_m = 0.0;
  for (double& y_m : record.y_m) y_m += off_m += step_m(random);
  const Diagnosis d = diagnosis_of(record);
  EXPECT_EQ(d.verdict, Verdict::nothing_missing);
  EXPECT_THAT(d.missing, testing::IsEmpty());
  ASSERT_TRUE(d.disturbance.has_value());
  EXPECT_EQ(d.disturbance->as, "reading");
  const double in_a_second_m = kWalk_m / std::sqrt(0.005);
  EXPECT_NEAR(d.disturbance->value, in_a_second_m, 0.25 * in_a_second_m);
}

}  // namespace
}  // namespace estimator::greybox::selection
