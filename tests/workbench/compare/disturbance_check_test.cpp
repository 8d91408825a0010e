#include "workbench/compare/disturbance_check.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "tests/workbench/compare/servo_record.h"
#include "workbench/compare/comparison_report.h"

namespace workbench::compare {

namespace greybox = estimator::greybox;
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A random speed of 1 mm/s RMS, first-order low-passed at 1 Hz, the same each time.
double wandering_mps(double t_s, double /*u_V*/, double /*y_m*/) {
  static const std::vector<double> speeds_mps = [] {
    std::mt19937 random(5);
    std::normal_distribution<double> drawn(0.0, 1e-3);
    const double kept = std::exp(-2.0 * std::numbers::pi * compare_test::kTs);
    std::vector<double> series{drawn(random)};
    while (series.size() < 6000) {
      series.push_back(kept * series.back() + std::sqrt(1.0 - kept * kept) * drawn(random));
    }
    return series;
  }();
  return speeds_mps.at(static_cast<std::size_t>(std::lround(t_s / compare_test::kTs)));
}

struct Checked {
  validation::Comparison comparison;
  DisturbanceCheck check;
};

Checked checked(const compare_test::Fault& fault,
                double observer_per_s = greybox::kObserver_per_s) {
  const plant_sim::ModelFile model = compare_test::servo();
  Checked out{
      validation::compare(model, greybox::dataset_of(compare_test::servo_record(fault, 30.0, 2e-6)),
                          observer_per_s),
      {}};
  out.check = check_disturbance(model, out.comparison, 2);
  return out;
}

double wandering_and_bent_mps(double t_s, double u_V, double y_m) {
  return wandering_mps(t_s, u_V, y_m) + 0.004 * std::cos(4.0 * u_V);
}

TEST(DisturbanceCheck, ClaimsNoIndependenceThatTheResidualLacks) {
  auto [c, check] = checked(wandering_mps);
  ASSERT_TRUE(check.found);
  c.independence_p = 0.5;
  EXPECT_THAT(words(c, check).lines, Contains(HasSubstr("follows neither command nor motion")));
  c.independence_p = 1e-9;
  EXPECT_THAT(words(c, check).lines,
              AllOf(Contains(HasSubstr("goes with earlier commands")),
                    Not(Contains(HasSubstr("follows neither command nor motion")))));
}

TEST(DisturbanceCheck, AFloorThatIsExceededIsNotReached) {
  auto [c, check] = checked(wandering_mps);
  ASSERT_TRUE(check.found);
  check.found->floor_m = 0.5 * c.rms_m;
  const Words said = words(c, check);
  EXPECT_NE(said.judgement, Judgement::at_floor);
  EXPECT_THAT(said.verdict, StartsWith("Above the noise floor"));
}

TEST(DisturbanceCheck, PutsTheFloorOfADisturbedRigBesideTheSensors) {
  const auto [c, check] = checked(wandering_mps);
  ASSERT_TRUE(check.found);
  const Words said = words(c, check);
  EXPECT_EQ(said.judgement, Judgement::at_floor);
  EXPECT_THAT(said.verdict, StartsWith("At the floor that sensor and disturbance would set"));
  EXPECT_THAT(said.lines, Contains(HasSubstr("a random speed of")));
  EXPECT_THAT(said.lines, Not(Contains(HasSubstr("parameters are off"))));
  EXPECT_THAT(to_text(c, false, false, check), HasSubstr("sensor, disturbance"));
  const nlohmann::json out = nlohmann::json::parse(to_json(c, check));
  EXPECT_EQ(out.at("judgement"), "at_floor");
  EXPECT_EQ(out.at("disturbance").at("as"), "speed");
  EXPECT_DOUBLE_EQ(out.at("disturbed_floor_m").get<double>(), check.found->floor_m);
  EXPECT_GT(check.found->floor_m, 10.0 * c.noise_floor_m);
  const present::Report report = make_report(c, "spoolwatch compare", check);
  EXPECT_EQ(report.state, present::ReportState::good);
  EXPECT_EQ(report.verdict, said.verdict);
}

TEST(DisturbanceCheck, LeavesAnEffectBesideADisturbanceAFailureOfTheModel) {
  const auto [c, check] = checked(wandering_and_bent_mps);
  EXPECT_TRUE(check.asked);
  EXPECT_FALSE(check.found);
  const Words said = words(c, check);
  EXPECT_NE(said.judgement, Judgement::at_floor);
  EXPECT_THAT(said.lines, Not(Contains(HasSubstr("A disturbance of the rig would explain"))));
  EXPECT_TRUE(nlohmann::json::parse(to_json(c, check)).at("disturbance").is_null());
}

TEST(DisturbanceCheck, RulesOutADisturbanceInWordsOnceItIsRuledOut) {
  validation::Comparison c = checked(wandering_mps).comparison;
  c.whiteness_p = 1e-9;
  c.independence_p = 0.5;
  c.headline.significant = false;
  EXPECT_THAT(words(c).verdict, HasSubstr("like a disturbance"));
  EXPECT_THAT(words(c).lines, Contains(HasSubstr("such as the sensor, the load or the supply")));
  const Words said = words(c, {.asked = true});
  EXPECT_THAT(said.verdict, AllOf(StartsWith("Fails"), Not(HasSubstr("disturbance"))));
  EXPECT_THAT(said.lines, Contains(HasSubstr("no disturbance of the rig accounts for it")));
  EXPECT_THAT(said.lines, Not(Contains(HasSubstr("such as the sensor"))));
}

TEST(CompareWords, NameThePartOfTheRecordThatHoldsThePositionError) {
  validation::Comparison c = checked(wandering_mps).comparison;
  c.headline.significant = false;
  c.independence_p = 1e-9;
  EXPECT_THAT(words(c, {.asked = true}).verdict, StartsWith("Fails throughout"));
  const auto times = std::find_if(c.regions.begin(), c.regions.end(),
                                  [](const auto& region) { return region.variable == "time"; });
  ASSERT_NE(times, c.regions.end());
  ASSERT_GT(times->bins.size(), 2U);
  for (validation::Bin& bin : times->bins) bin.error_share = 0.0;
  times->bins.front().error_share = 0.96;
  const Words said = words(c, {.asked = true});
  EXPECT_EQ(said.judgement, Judgement::fails_somewhere);
  EXPECT_THAT(said.verdict, HasSubstr("96 % of the squared position error lies there"));
  c.independence_p = 0.5;
  EXPECT_THAT(words(c).verdict, HasSubstr("like a disturbance"));
}

TEST(DisturbanceCheck, IsNotAskedWhereItWouldTellNothing) {
  EXPECT_FALSE(checked(compare_test::healthy).check.asked);
  EXPECT_FALSE(checked([](double, double, double) { return 0.002; }).check.asked);
  EXPECT_FALSE(checked(wandering_mps, 1.0).check.asked);
}

TEST(DisturbanceCheck, IsNotKnownOnceItIsCancelled) {
  const Checked c = checked(wandering_mps);
  const DisturbanceCheck cancelled =
      check_disturbance(compare_test::servo(), c.comparison, 1, [] { return true; });
  EXPECT_FALSE(cancelled.asked);
  EXPECT_FALSE(cancelled.found);
}

}  // namespace
}  // namespace workbench::compare
