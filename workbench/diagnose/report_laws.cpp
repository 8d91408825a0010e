// The section of the report that draws the laws that were learned.
#include <cmath>

#include "estimator/greybox/kinematics.h"
#include "workbench/diagnose/learned_curves.h"
#include "workbench/diagnose/model_residuals.h"
#include "workbench/diagnose/report_sections.h"
#include "workbench/diagnose/residual_plots.h"
#include "workbench/diagnose/residual_source.h"

namespace workbench::diagnose {
namespace {

using present::Plot;
using present::Series;
using present::Tone;

/// The remainder without the law, where that is a force over a variable that is measured.
Series points_of(const DiagnosisReport& outcome, const LearnedLaw& learned) {
  const greybox::FitDataset& data = outcome.prepared->problem.data;
  plant_sim::ModelFile without = outcome.diagnosis.better;
  if (learned.curve.quantity != "force_N" || without.plant != "force_driven_axis") return {};
  if (learned.curve.held) return {};  // one curve of many
  for (plant_sim::ModelFile::Effect& effect : without.effects) {
    if (effect.name == learned.law->effect.name) effect.present = false;
  }
  const Eigen::VectorXd residual_m = residual_of_model_m(without, data, greybox::kObserver_per_s);
  std::vector<double> x;
  std::vector<double> f;
  for (std::size_t r = 0; r < data.records.size(); ++r) {
    const greybox::Dataset& record = data.records[r];
    const double noise_m = std::isfinite(data.noise_floor_m) ? data.noise_floor_m : 0.0;
    const std::vector<double> over = learned.curve.variable == "v_mps"
                                         ? greybox::kinematics(record, noise_m).speed_mps
                                         : record.y_m;
    const std::vector<double> force =
        residual_source(without, record, counted_part(residual_m, data.starts[r], record)).values;
    x.insert(x.end(), over.begin(), over.end());
    f.insert(f.end(), force.begin(), force.end());
  }
  return cloud("residual force without it", x, f, Tone::residual);
}

Plot law_plot(const DiagnosisReport& outcome, const LearnedLaw& learned) {
  const estimator::greybox::LawCurve& curve = learned.curve;
  const LawAxes axes = axes_of(curve);
  Plot plot;
  plot.title = learned.law->effect.name;
  plot.x = {axes.x_name, axes.x_unit};
  plot.y = {axes.y_name, axes.y_unit};
  Series points = points_of(outcome, learned);
  points.x = scaled(std::move(points.x), axes.x_per);
  if (!points.y.empty()) plot.series.push_back(std::move(points));
  Series line{
      .name = "the law", .y = curve.f, .x = scaled(curve.x, axes.x_per), .tone = Tone::model};
  for (std::size_t i = 0; i < curve.f.size(); ++i) {
    line.low.push_back(curve.f[i] - 2.0 * curve.std_error[i]);
    line.high.push_back(curve.f[i] + 2.0 * curve.std_error[i]);
  }
  line.kind = present::PlotKind::line;
  plot.series.push_back(std::move(line));
  plot.caption = learned.law->effect.what + ": " + learned.law->effect.equation() +
                 ". The band is two standard errors; it ends where the records do.";
  if (!axes.held.empty()) plot.caption += " " + axes.held;
  return plot;
}

}  // namespace

present::Section laws_section(const DiagnosisReport& outcome) {
  const bool learned_whole = outcome.diagnosis.verdict == selection::Verdict::learned;
  present::Section section{.heading = learned_whole ? "The learned law"
                                                    : "The nearest law, which is not established"};
  section.paragraphs = {
      "What the law adds at its site, over one variable, and its standard error. Points: what is "
      "left of the measured motion without it, where that can be told."};
  for (const LearnedLaw& learned : learned_laws(outcome)) {
    section.plots.push_back(law_plot(outcome, learned));
  }
  return section;
}

}  // namespace workbench::diagnose
