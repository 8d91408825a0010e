#include "workbench/serve/job_summary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/workbench/diagnose/example_outcome.h"

namespace workbench::serve {
namespace {

namespace selection = estimator::greybox::selection;
using nlohmann::ordered_json;

TEST(JobSummary, ALearnedLawIsACurveWithItsErrorsInTheUnitsOfItsAxes) {
  diagnose::ExampleReport report;
  selection::Diagnosis& d = report.diagnosis;
  d.better = plant_sim::load_model(SPOOLWATCH_SOURCE_DIR "/config/models/force_driven_axis.toml");
  const plant_sim::formula::FormulaEffect effect{
      "cubic_damping", "force", "c * v_mps^3", "drag", {{"c", "size", 0.0, 1e6, 1e3, 0.0}}, "", {}};
  d.better.declare(effect, "test");
  *d.better.value("cubic_damping.c") = 800.0;
  d.verdict = selection::Verdict::learned;
  d.laws = {{effect, {"v"}}};
  d.parameters = {{"cubic_damping.c", 800.0, 4.0, false}};
  const ordered_json law = summary_of(report)["laws"][0];
  EXPECT_EQ(law["formula"], "c * v_mps^3");
  const ordered_json& curve = law["curve"];
  EXPECT_EQ(curve["x"], "velocity, mm/s");
  EXPECT_EQ(curve["y"], "force, N");
  ASSERT_GT(curve["model"]["x"].size(), 3U);
  const double v_mps = 1e-3 * curve["model"]["x"][3].get<double>();
  EXPECT_NEAR(curve["model"]["y"][3], 800.0 * std::pow(v_mps, 3), 1e-6);
  EXPECT_NEAR(curve["high"][3], 800.0 * std::pow(v_mps, 3) + 8.0 * std::abs(std::pow(v_mps, 3)),
              1e-6);
  EXPECT_NEAR(curve["low"][3], 800.0 * std::pow(v_mps, 3) - 8.0 * std::abs(std::pow(v_mps, 3)),
              1e-6);
}

}  // namespace
}  // namespace workbench::serve
