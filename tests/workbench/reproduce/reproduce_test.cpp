// Our figures against an independent implementation in NumPy (reference.py), and the agreements
// that must not be lost. The plant of both integrates by Runge-Kutta, ours with steps of 1 ms, the
// other with 0.25 ms: the tolerances are what that leaves.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/workbench/reproduce/reference.h"
#include "workbench/reproduce/experiment.h"

namespace workbench::reproduce {
namespace {

/// Tolerance of b1: 1 ms against 0.25 ms.
constexpr double kB1 = 1e-6;
/// Tolerance of a cost: the same, in squares of small differences.
constexpr double kCost = 1e-3;

class Rows {
 public:
  explicit Rows(std::vector<ReproducedRow> rows) : rows_(std::move(rows)) {}

  const ReproducedRow& at(const std::string& what) const {
    static const ReproducedRow kNone;
    const auto found = std::find_if(rows_.begin(), rows_.end(),
                                    [&](const ReproducedRow& row) { return row.what == what; });
    if (found == rows_.end()) ADD_FAILURE() << "no row " << what;
    return found == rows_.end() ? kNone : *found;
  }
  double number(const std::string& what) const {
    const auto* value = std::get_if<double>(&at(what).ours);
    if (value == nullptr) ADD_FAILURE() << what << " is no number";
    return value == nullptr ? 0.0 : *value;
  }
  const std::vector<ReproducedRow>& all() const { return rows_; }

 private:
  std::vector<ReproducedRow> rows_;
};

void expect_relative(double ours, double reference, double tolerance) {
  EXPECT_LE(std::abs(ours / reference - 1.0), tolerance) << ours << " against " << reference;
}

/// Every row that is meant to agree does.
void expect_expected(const Rows& rows) {
  for (const ReproducedRow& row : rows.all()) {
    if (!row.expected) continue;
    EXPECT_EQ(row.agrees, Agreement::yes) << row.what;
  }
}

TEST(Reproduce, CalibratedModelGivesThePrintedB1AndTheOneOfNumPy) {
  const Rows rows(printed_parameters());
  expect_relative(rows.number("b1 of ARX111, valve constant calibrated, m/V"), reference::kB1, kB1);
  expect_expected(rows);
  EXPECT_EQ(rows.at("b1 of ARX111, parameters as printed, m/V").agrees, Agreement::no);
}

TEST(Reproduce, StructureCostsAgreeWithNumPyInStepAndOut) {
  const Rows rows(structure_costs());
  expect_relative(rows.number("E of ARX111, in step, m2"), reference::kCost111_m2, kCost);
  expect_relative(rows.number("E of ARX211, in step, m2"), reference::kCost211_m2, kCost);
  // Near-singular: the last digits of the record decide more.
  expect_relative(rows.number("E of ARX311, in step, m2"), reference::kCost311_m2, 0.02);
  expect_relative(rows.number("E of ARX411, in step, m2"), reference::kCost411_m2, 0.02);
  expect_relative(rows.number("E of ARX111, one sample out of step, m2"),
                  reference::kCostLate111_m2, 1e-4);
  expect_relative(rows.number("E of ARX211, one sample out of step, m2"),
                  reference::kCostLate211_m2, 1e-4);
  expect_relative(rows.number("E of ARX311, one sample out of step, m2"),
                  reference::kCostLate311_m2, 1e-4);
  expect_relative(rows.number("E of ARX411, one sample out of step, m2"),
                  reference::kCostLate411_m2, 1e-4);
}

TEST(Reproduce, CostsThatAreNotReproducedAreSaidNotToBe) {
  const Rows rows(structure_costs());
  EXPECT_EQ(rows.at("E of ARX111, in step, m2").agrees, Agreement::no);
  EXPECT_EQ(rows.at("E of ARX111, one sample out of step, m2").agrees, Agreement::no);
  EXPECT_EQ(rows.at("E of ARX411, one sample out of step, m2").agrees, Agreement::no);
}

TEST(Reproduce, SensitivitiesAgreeWithNumPyAndWithPrint) {
  const Rows pressure(pressure_sensitivity());
  EXPECT_NEAR(pressure.number("b1 for Ps +10 %, change in %"), reference::kPressureUp_percent,
              1e-4);
  EXPECT_NEAR(pressure.number("b1 for Ps -10 %, change in %"), reference::kPressureDown_percent,
              1e-4);
  expect_relative(pressure.number("lowest b1, Ps 500 to 1500 psi, m/V"), reference::kPressureLow,
                  kB1);
  expect_relative(pressure.number("highest b1, Ps 500 to 1500 psi, m/V"), reference::kPressureHigh,
                  kB1);
  expect_expected(pressure);
  const Rows damping(damping_sensitivity());
  EXPECT_NEAR(damping.number("b1 for d +10 %, change in %"), reference::kDampingUp_percent, 1e-4);
  EXPECT_NEAR(damping.number("b1 for d -10 %, change in %"), reference::kDampingDown_percent, 1e-4);
  expect_relative(damping.number("lowest b1, d 500 to 1500 N s/m, m/V"), reference::kDampingLow,
                  kB1);
  expect_relative(damping.number("highest b1, d 500 to 1500 N s/m, m/V"), reference::kDampingHigh,
                  kB1);
  expect_expected(damping);
}

void expect_case(const Rows& rows, const double (&b1)[6]) {
  const char* const ends[] = {"14", "16", "18", "32", "46", "48"};
  for (int i = 0; i < 6; ++i) {
    expect_relative(
        rows.number(std::string("b1 of the period that ends at ") + ends[i] + " s, m/V"), b1[i],
        kB1);
  }
  expect_expected(rows);
}

TEST(Reproduce, CaseOneRunsAsPrintedAndAsInNumPy) {
  const Rows rows(case_one());
  expect_case(rows, reference::kCaseOneB1);
  EXPECT_NEAR(rows.number("alarm on (b1 above its band), s"), 17.995, 1e-9);
  EXPECT_NEAR(rows.number("alarm off, s"), 31.995, 1e-9);
  EXPECT_NEAR(rows.number("alarm on (b1 below its band), s"), 47.995, 1e-9);
}

TEST(Reproduce, CaseTwoRunsAsPrintedAndAsInNumPy) {
  const Rows rows(case_two());
  expect_case(rows, reference::kCaseTwoB1);
  EXPECT_NEAR(rows.number("alarm on (b1 below its band), s"), 17.995, 1e-9);
  EXPECT_NEAR(rows.number("alarm off, s"), 31.995, 1e-9);
  EXPECT_NEAR(rows.number("alarm on (b1 above its band), s"), 47.995, 1e-9);
}

TEST(Reproduce, CaseThreeIsNotIsolated) { expect_expected(Rows(isolation())); }

TEST(Reproduce, SlidingWindowSeesAFaultWithinThreeAndAtWorstSixTenthsOfASecond) {
  const Rows rows(detection_delay());
  expect_expected(rows);
}

TEST(Reproduce, RecursiveSpreadOfB1FollowsFromOneForgettingFactor) {
  expect_expected(Rows(batch_against_recursive()));
}

TEST(Reproduce, StandAt2000PsiAlarmsAtThePrintedTimes) { expect_expected(Rows(rig_experiment())); }

TEST(Reproduce, SlavesAreSeparableAndTheNeedleValveIsNot) { expect_expected(Rows(needle_valve())); }

TEST(Reproduce, ResultsDoNotDependOnTheNumberOfThreads) {
  const auto few = experiments().first(2);
  const auto one = run_all(few, 1);
  const auto two = run_all(few, 2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].title, two[i].title);
    ASSERT_EQ(one[i].rows.size(), two[i].rows.size());
    for (std::size_t j = 0; j < one[i].rows.size(); ++j) {
      EXPECT_EQ(one[i].rows[j].ours, two[i].rows[j].ours) << one[i].rows[j].what;
    }
  }
}

TEST(Reproduce, NamesOfRowsAreUniqueWithinASection) {
  for (const ReproducedSection& section : run_all(experiments().first(3), 2)) {
    std::set<std::string> seen;
    for (const ReproducedRow& row : section.rows)
      EXPECT_TRUE(seen.insert(row.what).second) << row.what;
  }
}

}  // namespace
}  // namespace workbench::reproduce
