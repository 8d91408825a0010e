// The section of the report that shows what each step of the ladder takes away: the residual before
// and after it, over time and over the variable whose shape it has.
#include <algorithm>
#include <cmath>

#include "config/schema/joined.h"
#include "estimator/greybox/kinematics.h"
#include "workbench/diagnose/model_residuals.h"
#include "workbench/diagnose/report_sections.h"
#include "workbench/diagnose/residual_plots.h"
#include "workbench/diagnose/residual_source.h"
#include "workbench/present/record_section.h"

namespace workbench::diagnose {
namespace {

using present::Plot;
using present::Tone;

constexpr std::size_t kMostSteps = 4;

/// A model on the way from the file's to the better one.
struct Stage {
  std::vector<std::string> added;
  plant_sim::ModelFile model;
  std::vector<double> residual_m;  ///< the first record's
};

/// The stages that the search has kept, the first without effect, the last the better model.
std::vector<Stage> stages_of(const DiagnosisReport& outcome) {
  const selection::Diagnosis& d = outcome.diagnosis;
  const selection::DiagnosisProblem& problem = outcome.prepared->problem;
  const greybox::Dataset& record = problem.data.records.front();
  std::vector<Stage> stages;
  for (const selection::Round& round : d.search.rounds) {
    std::vector<std::string> added = round.before.added;
    const bool on_the_way =
        added.size() < d.missing.size() &&
        std::all_of(added.begin(), added.end(), [&](const std::string& one) {
          return std::find(d.missing.begin(), d.missing.end(), one) != d.missing.end();
        });
    const bool further = stages.empty() || added.size() > stages.back().added.size();
    if (!on_the_way || !further || round.before.fitted.theta.size() == 0) continue;
    Stage stage{std::move(added), greybox::with_values(problem.model, round.before.fitted), {}};
    stage.residual_m = counted_part(
        residual_of_m(problem, round.before.fitted, greybox::kObserver_per_s), 0, record);
    stages.push_back(std::move(stage));
  }
  if (stages.empty()) return {};
  stages.push_back(
      {d.missing, d.better,
       counted_part(residual_of_better_m(outcome, greybox::kObserver_per_s), 0, record)});
  return stages;
}

std::string name_of(const Stage& before, const Stage& after) {
  std::vector<std::string> names;
  for (const std::string& one : after.added) {
    if (std::find(before.added.begin(), before.added.end(), one) == before.added.end()) {
      names.push_back(one);
    }
  }
  return config::schema::joined(names, " + ");
}

Plot over_time(const greybox::Dataset& record, const Stage& before, const Stage& after) {
  const auto rms = [](const std::vector<double>& values) {
    double sum = 0.0;
    double count = 0.0;
    for (const double value : values) {
      if (!std::isfinite(value)) continue;
      sum += value * value;
      ++count;
    }
    return std::sqrt(sum / count);
  };
  const present::ErrorUnit unit = present::error_unit(rms(before.residual_m));
  Plot plot = present::over_time(record.t_s, "Residual without and with " + name_of(before, after),
                                 {"measured − model", unit.name}, record.name);
  present::add_series(plot, "without", Tone::residual, scaled(before.residual_m, unit.per_m));
  present::add_series(plot, "with", Tone::improved, scaled(after.residual_m, unit.per_m));
  plot.width = present::PlotWidth::half;
  return plot;
}

/// Over the variable in which the residual without the step has the clearest shape.
Plot over_motion(const std::vector<MotionVariable>& variables, const greybox::Dataset& record,
                 const Stage& before, const Stage& after) {
  const ResidualSource without = residual_source(before.model, record, before.residual_m);
  const ResidualSource with = residual_source(after.model, record, after.residual_m);
  const MotionVariable& x = *std::max_element(
      variables.begin(), variables.end(), [&](const MotionVariable& a, const MotionVariable& b) {
        return shape_share(a.values, without.values) < shape_share(b.values, without.values);
      });
  Plot plot;
  plot.title = "The same against " + x.axis.label;
  plot.kind = present::PlotKind::scatter;
  plot.width = present::PlotWidth::half;
  plot.x = x.axis;
  plot.y = without.axis;
  plot.series = {cloud("without", x.values, without.values, Tone::residual),
                 mean_curve("its mean", x.values, without.values, Tone::measured),
                 mean_curve("mean with it", x.values, with.values, Tone::improved)};
  return plot;
}

}  // namespace

std::optional<present::Section> steps_section(const DiagnosisReport& outcome) {
  // the better model has a change beside the effects, which the steps' models have not
  const bool changes = outcome.diagnosis.verdict == selection::Verdict::changing;
  if (outcome.diagnosis.missing.empty() || changes) return std::nullopt;
  const std::vector<Stage> stages = stages_of(outcome);
  if (stages.size() < 3) return std::nullopt;  // one step: the record's own section shows it
  const greybox::FitDataset& data = outcome.prepared->problem.data;
  const greybox::Dataset& record = data.records.front();
  const double noise_m = std::isfinite(data.noise_floor_m) ? data.noise_floor_m : 0.0;
  const std::vector<MotionVariable> variables =
      motion_variables(record, greybox::kinematics(record, noise_m));
  present::Section section{.heading = "The argument"};
  section.paragraphs = {
      "What each step takes away, on the first record. Left: the drift-corrected residual without "
      "and with the effect. Right: where it arises, against the variable that it follows most; a "
      "shape that goes with the step is what the step explains."};
  for (std::size_t i = 1; i < std::min(stages.size(), kMostSteps + 1); ++i) {
    section.plots.push_back(over_time(record, stages[i - 1], stages[i]));
    section.plots.push_back(over_motion(variables, record, stages[i - 1], stages[i]));
  }
  return section;
}

}  // namespace workbench::diagnose
