// The report's page, from a diagnosis made by hand on a record made here.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/estimator/greybox/selection/servo_problem.h"
#include "tests/workbench/diagnose/example_outcome.h"
#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/diagnose/report_sections.h"

namespace workbench::diagnose {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// Nothing is missing beside a gain that grows by a tenth half way. The model as given has the
/// first half's gain throughout, the better model the second half's.
struct ChangingReport : ExampleReport {
  ChangingReport() {
    input.problem = diagnose_test::servo_context({.rate_mps = [](double u_V, double, double t_s) {
                      return 0.05 * (t_s < 10.0 ? 1.0 : 1.1) * u_V;
                    }}).problem;
    selection::Diagnosis& d = diagnosis;
    d.verdict = selection::Verdict::changing;
    d.by_innovations = true;
    d.missing.clear();
    d.changing = {
        {.parameter = "gain_mps_per_V", .at_s = 10.0, .is_dated = true, .from = 0.05, .to = 0.055}};
    d.better = input.problem.model;
    d.final = fit_at(0.055);
    selection::ModelStage given{{}, fit_at(0.05)};
    d.search.path = {given, {{"change.gain_mps_per_V"}, d.final}};
    d.search.rounds.front().before = given;
    d.search.final = d.search.path.back();
  }

  [[nodiscard]] greybox::FitSummary fit_at(double gain_mps_per_V) {
    greybox::FitSummary fitted = example_fit(1e-5);
    fitted.parameters = input.problem.plant_parameters;
    plant_sim::ModelFile model = input.problem.model;
    *model.value("gain_mps_per_V") = gain_mps_per_V;
    fitted.theta = greybox::start_of(model, fitted.parameters);
    return fitted;
  }
};

const present::Plot* find_plot(const present::Section& section, const std::string& title) {
  const auto found = std::find_if(section.plots.begin(), section.plots.end(),
                                  [&](const present::Plot& plot) { return plot.title == title; });
  return found == section.plots.end() ? nullptr : &*found;
}

/// Largest residual of the half of the record, in micrometres or millimetres as it is drawn.
double largest(const present::Plot& plot, bool second_half) {
  const std::vector<double>& values = plot.series.front().y;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  double most = 0.0;
  for (auto it = second_half ? middle : values.begin(); it != (second_half ? values.end() : middle);
       ++it) {
    if (std::isfinite(*it)) most = std::max(most, std::abs(*it));
  }
  return most;
}

TEST(DiagnosisPage, ShowsTheResidualWithoutAndWithAChangeUnderTheirNames) {
  const ChangingReport outcome;
  const std::vector<present::Section> sections = record_sections(outcome);
  ASSERT_EQ(sections.size(), 1U);
  const present::Plot* const before = find_plot(sections[0], "Residual before");
  const present::Plot* const after = find_plot(sections[0], "Residual after");
  ASSERT_NE(before, nullptr);
  ASSERT_NE(after, nullptr);
  EXPECT_EQ(find_plot(sections[0], "Residual, its parameters fitted"), nullptr);
  // the model as given fails in the second half, the other in the first
  EXPECT_GT(largest(*before, true), 5.0 * largest(*before, false));
  EXPECT_GT(largest(*after, false), 1.5 * largest(*after, true));
  EXPECT_THAT(sections[0].paragraphs.front(), HasSubstr("after: the better model"));
}

TEST(DiagnosisPage, NamesTheErrorLeftWithAChange) {
  const ChangingReport outcome;
  std::vector<std::string> labels;
  for (const present::Fact& fact : report_of(outcome).facts) labels.push_back(fact.label);
  EXPECT_THAT(labels, Contains("With the change"));
  EXPECT_THAT(labels, Not(Contains("Effects added")));
}

TEST(DiagnosisPage, SpeaksOfADisturbanceWhereOneWasFound) {
  ChangingReport outcome;
  EXPECT_THAT(candidates_section(outcome).paragraphs, Not(Contains(HasSubstr("disturb"))));
  outcome.diagnosis.disturbance = selection::Disturbance{"force", 10.0, 3.0, 1e-5, 0.5, {}};
  EXPECT_THAT(candidates_section(outcome).paragraphs,
              Contains(HasSubstr("which the rig's disturbance dominates")));
}

}  // namespace
}  // namespace workbench::diagnose
