// An axis without a stroke, whose speed hardly goes with its command because friction is missing
// in the model: nothing but the search for effects tells what was misread.
#include "estimator/greybox/selection/other_readings.h"

#include <gmock/gmock.h>

#include <utility>

#include "estimator/greybox/selection/diagnosis.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

Dataset rubbing_axis() {
  return diagnose_test::dataset_of(truth::simulate(truth::parse_case(
      "rig=linear_axis,motion=multisine,length_s=15,plant=printed,friction.coulomb_N=30", 95)));
}

SearchContext axis_context(Dataset record) {
  plant_sim::ModelFile model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                     "/config/models/force_driven_axis.toml");
  SearchContext context{make_problem(std::move(model), fit_dataset({std::move(record)}, {})), {}};
  context.options.threads = 2;
  return context;
}

template <class Change>
Diagnosis diagnosis_of(const Change& change) {
  Dataset record = rubbing_axis();
  change(record);
  const SearchContext context = axis_context(std::move(record));
  return diagnose(context.problem, context.options);
}

/// Refused for how it was read, before any effect was sought.
void expect_misread(const Diagnosis& found) {
  ASSERT_TRUE(found.checks);
  EXPECT_TRUE(found.checks->misread());
  EXPECT_EQ(found.verdict, Verdict::unexplained);
  EXPECT_TRUE(found.search.rounds.empty());
}

TEST(OtherReadings, ATurnedSignOfAnAxisIsNoticedBesideFriction) {
  const Diagnosis found = diagnosis_of([](Dataset& record) {
    for (double& u_V : record.u_V) u_V = -u_V;
  });
  expect_misread(found);
  EXPECT_GT(found.checks->turned_sign_ratio, 3.0);
  EXPECT_FALSE(found.checks->columns_exchanged);
}

TEST(OtherReadings, ExchangedColumnsOfAnAxisAreNoticedBesideFriction) {
  const Diagnosis found = diagnosis_of([](Dataset& record) { std::swap(record.u_V, record.y_m); });
  expect_misread(found);
  EXPECT_TRUE(found.checks->columns_exchanged);
  EXPECT_GT(found.checks->exchanged_ratio, 3.0);
  EXPECT_FALSE(found.checks->turned_sign());
}

TEST(OtherReadings, MillimetresOfAnAxisAreNoticedBesideFriction) {
  const Diagnosis found = diagnosis_of([](Dataset& record) {
    for (double& y_m : record.y_m) y_m *= 1000.0;
  });
  expect_misread(found);
  EXPECT_TRUE(found.checks->wrong_scale);
}

TEST(OtherReadings, AnAxisThatIsReadRightlyIsNotDoubted) {
  const Diagnosis found = diagnosis_of([](Dataset&) {});
  EXPECT_EQ(found.verdict, Verdict::missing);
  EXPECT_THAT(found.missing, testing::ElementsAre("friction"));
  EXPECT_FALSE(found.checks && found.checks->misread());
}

}  // namespace
}  // namespace estimator::greybox::selection
