// Every effect of the library alone on two motions, pairs, healthy records and effects that are not
// in the library, drawn and simulated by tests/truth. Minutes; scripts/confusion has hundreds more.
// With SPOOLWATCH_EVERY=N each N-th record alone.
#include <gmock/gmock.h>

#include <cstdio>
#include <cstdlib>

#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/truth_records.h"
#include "tests/truth/plan.h"
#include "tests/workbench/diagnose/judged.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;
namespace {

using diagnose_test::said;

constexpr std::size_t kSeed = 2027;
/// Friction counts three times: Coulomb, with Stribeck, with pre-sliding.
constexpr std::size_t kKinds = 20;

struct Count {
  int right = 0;
  int at_floor = 0;
  int records = 0;
  [[nodiscard]] double share() const { return static_cast<double>(right) / records; }
};

std::size_t every() {
  const char* const given = std::getenv("SPOOLWATCH_EVERY");
  return given != nullptr ? std::stoul(given) : 1;
}

/// Counts records of a plan for which `right` holds, and writes down the others.
template <class Right>
Count count_of(const std::string& plan, std::size_t records, const Right& right) {
  Count count;
  for (std::size_t i = 0; i < records; i += every()) {
    truth::Record record;
    const truth::Planned planned = truth::plan_record(plan, kSeed, i, record);
    const selection::Diagnosis d =
        diagnose_test::found_in(diagnose_test::context_with(diagnose_test::dataset_of(record)));
    ++count.records;
    if (right(planned, d)) {
      ++count.right;
      count.at_floor += d.rms_after_m <= diagnose_test::kAtFloor * d.noise_floor_m ? 1 : 0;
    } else {
      std::printf("%s %zu: %s\n  found %s\n", plan.c_str(), i, planned.text.c_str(),
                  said(d).c_str());
    }
  }
  std::printf("%s: %d of %d right\n", plan.c_str(), count.right, count.records);
  return count;
}

TEST(HiddenEffects, AreNamedOneByOneOnTwoMotionsEach) {
  const Count count =
      count_of("single", 2 * kKinds, [](const auto& planned, const selection::Diagnosis& d) {
        return diagnose_test::is_right(d, planned.hidden);
      });
  EXPECT_GE(count.share(), 0.95);
  EXPECT_GE(count.at_floor, 0.9 * count.right);
}

TEST(HiddenEffects, AreNamedTwoByTwo) {
  const Count count = count_of("pairs", 14, [](const auto& planned, const selection::Diagnosis& d) {
    return diagnose_test::is_right(d, planned.hidden);
  });
  EXPECT_GE(count.share(), 0.85);
}

TEST(HiddenEffects, AreNotFoundOnHealthyRecords) {
  const Count count =
      count_of("healthy", 10, [](const auto& /*planned*/, const selection::Diagnosis& d) {
        return d.verdict == selection::Verdict::nothing_missing;
      });
  EXPECT_EQ(count.right, count.records);
}

TEST(HiddenEffects, OutsideTheLibraryAreLearnedOrUnexplainedByTheRightVariable) {
  const std::size_t kinds = truth::left_out_table().size();
  const Count count =
      count_of("leftout", kinds, [](const auto& planned, const selection::Diagnosis& d) {
        const truth::LeftOutInfo& info = *truth::find_left_out(planned.of.left_out.kind);
        bool named = false;
        for (std::size_t i = 0; i < std::min<std::size_t>(2, d.where.size()); ++i) {
          named = named || std::find(info.variables.begin(), info.variables.end(),
                                     d.where[i].variable) != info.variables.end();
        }
        const bool goes_with_time =
            std::find(info.variables.begin(), info.variables.end(), "time") != info.variables.end();
        return named && (d.verdict == selection::Verdict::unexplained ||
                         d.verdict == selection::Verdict::learned ||
                         (goes_with_time && d.verdict == selection::Verdict::changing));
      });
  EXPECT_GE(count.share(), 0.8);
}

TEST(HiddenEffects, FrictionAndANullBiasAreBothNamed) {
  const selection::Diagnosis d = diagnose_test::found_in(diagnose_test::context_of(
      "motion=multisine,friction.coulomb_N=150,null_bias.offset_V=0.07", 14));
  EXPECT_EQ(d.verdict, selection::Verdict::missing) << said(d);
  EXPECT_THAT(d.missing, testing::UnorderedElementsAre("friction", "null_bias")) << said(d);
  EXPECT_LE(d.rms_after_m, diagnose_test::kAtFloor * d.noise_floor_m) << said(d);
}

TEST(HiddenEffects, ADragWithTheCubeOfTheSpeedIsLearned) {
  const selection::Diagnosis d = diagnose_test::found_in(
      diagnose_test::context_of("motion=multisine,left_out=cubic_damping,left_out.size=2.5e5", 16));
  EXPECT_EQ(d.verdict, selection::Verdict::learned) << said(d);
  ASSERT_EQ(d.laws.size(), 1U);
  EXPECT_EQ(d.laws[0].effect.name, "cubic_damping");
  const auto size = std::find_if(d.parameters.begin(), d.parameters.end(), [](const auto& p) {
    return p.name == "cubic_damping.coefficient_N_s3_per_m3";
  });
  ASSERT_NE(size, d.parameters.end());
  EXPECT_NEAR(size->value, 2.5e5, 3.0 * size->std_error);
  EXPECT_LE(d.rms_after_m, diagnose_test::kAtFloor * d.noise_floor_m) << said(d);
  ASSERT_FALSE(d.where.empty());
  EXPECT_EQ(d.where[0].site, "force") << said(d);
  EXPECT_THAT(d.where[0].variable, testing::AnyOf("speed", "v")) << said(d);
}

}  // namespace
}  // namespace workbench::diagnose
