// The sections of the report that hold each record against the model before and after.
#include <algorithm>
#include <cmath>

#include "config/signals/nan.h"
#include "estimator/greybox/kinematics.h"
#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/diagnose/model_residuals.h"
#include "workbench/diagnose/residual_plots.h"
#include "workbench/diagnose/residual_source.h"
#include "workbench/diagnose/words.h"
#include "workbench/present/dynamics_plots.h"
#include "workbench/present/record_section.h"

namespace workbench::diagnose {
namespace {

using present::Plot;
using present::PlotKind;
using present::Section;
using present::Tone;

using config::signals::kNaN;
/// Residuals above this are drawn in millimetres.
constexpr double kMillimetres_m = 2e-3;

/// The long series of residuals, of all records, and the model without what was added.
struct Residuals {
  plant_sim::ModelFile before;
  Eigen::VectorXd file_m, before_m, after_m, free_file_m, free_after_m;
  Eigen::MatrixXd free_deviated_m;
};

/// One residual in the unit that it is drawn in.
struct ResidualScale {
  double per_m = 1e6;
  const char* unit = "µm";
};

struct RecordPage {
  const greybox::Dataset& record;
  greybox::Kinematics kinematics;
  std::vector<double> file_m, before_m, after_m, free_file_m,
      free_after_m;                                  ///< NaN where it does not count
  std::vector<std::vector<double>> free_deviated_m;  ///< NamedValues::deviated
  ResidualSource before, after;
  double noise_floor_m = kNaN;
  bool improved = false;  ///< an effect or a change was added
};

ResidualScale scale_of(const std::vector<double>& residual_m) {
  double most_m = 0.0;
  for (const double r : residual_m) {
    if (std::isfinite(r)) most_m = std::max(most_m, std::abs(r));
  }
  return most_m > kMillimetres_m ? ResidualScale{1e3, "mm"} : ResidualScale{};
}

/// Nothing is drawn across a gap.
std::vector<double> broken_at_gaps(std::vector<double> values, const greybox::Dataset& record) {
  for (const std::size_t start : record.starts) {
    if (start > 0) values[start] = kNaN;
  }
  return values;
}

Plot time_plot(const RecordPage& page, const std::string& title, const present::Axis& y) {
  return present::over_time(page.record.t_s, title, y, page.record.name);
}

std::vector<double> model_mm(const RecordPage& page, const std::vector<double>& residual_m) {
  std::vector<double> out(residual_m.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = 1e3 * (page.record.y_m[i] - residual_m[i]);
  return out;
}

Plot position_plot(const RecordPage& page, bool fitted) {
  Plot plot = time_plot(page, "Position", {"position", "mm"});
  plot.series.push_back({.name = "measured",
                         .y = broken_at_gaps(scaled(page.record.y_m, 1e3), page.record),
                         .tone = Tone::measured});
  if (!fitted) return plot;
  plot.series.push_back({.name = "model file, free run",
                         .y = model_mm(page, page.free_file_m),
                         .tone = Tone::residual,
                         .dashed = true});
  plot.series.push_back({.name = "better model, free run",
                         .y = model_mm(page, page.free_after_m),
                         .tone = Tone::improved});
  plot.caption = "Free run: without correction, errors accumulate.";
  return plot;
}

Plot residual_plot(const RecordPage& page, const std::string& title,
                   const std::vector<double>& residual_m, Tone tone) {
  const ResidualScale scale = scale_of(residual_m);
  Plot plot = time_plot(page, title, {"measured − model", scale.unit});
  plot.series.push_back({.name = "residual", .y = scaled(residual_m, scale.per_m), .tone = tone});
  present::add_noise_band(plot, page.noise_floor_m, scale.per_m);
  return plot;
}

Plot command_plot(const RecordPage& page) {
  Plot plot = time_plot(page, "Command", {"command", "V"});
  plot.series.push_back({.name = "command",
                         .y = broken_at_gaps(page.record.u_V, page.record),
                         .tone = Tone::muted,
                         .kind = PlotKind::steps});
  return plot;
}

/// Residual without what was added, and with it, against one variable: on an axis each.
void add_against(const RecordPage& page, const MotionVariable& x, Section& section) {
  const auto plot_of = [&](const ResidualSource& source, const char* when, Tone tone) {
    Plot plot{.title = "Residual " + std::string(when) + "against " + x.axis.label,
              .kind = PlotKind::scatter,
              .x = x.axis,
              .y = source.axis,
              .width = present::PlotWidth::half};
    plot.series = {cloud("residual", x.values, source.values, tone),
                   mean_curve("mean", x.values, source.values, Tone::model)};
    section.plots.push_back(std::move(plot));
  };
  if (page.improved) plot_of(page.before, "before ", Tone::residual);
  plot_of(page.after, page.improved ? "after " : "", Tone::improved);
}

void add_clouds(const RecordPage& page, Section& section) {
  const std::vector<MotionVariable> variables = motion_variables(page.record, page.kinematics);
  const std::size_t drawn = page.improved ? 2 : variables.size();
  for (std::size_t i = 0; i < drawn; ++i) add_against(page, variables[i], section);
}

void add_dynamics(const RecordPage& page, Section& section) {
  const auto position = [&](const std::vector<double>& free_error_m) {
    std::vector<double> modelled_m = page.record.y_m;
    for (std::size_t k = 0; k < modelled_m.size(); ++k) {
      // the speeds of samples that do not count are not asked for
      if (std::isfinite(free_error_m[k])) modelled_m[k] -= free_error_m[k];
    }
    return modelled_m;
  };
  std::vector<present::NamedValues> models{
      {"model file", Tone::residual, position(page.free_file_m)},
      {"better model", Tone::improved, position(page.free_after_m)}};
  for (const std::vector<double>& error_m : page.free_deviated_m) {
    models.back().deviated.push_back(position(error_m));
  }
  for (Plot& plot : present::response_plots(page.record, models, page.noise_floor_m)) {
    section.plots.push_back(std::move(plot));
  }
  std::vector<present::NamedValues> residuals;
  if (page.improved) residuals.push_back({"before", Tone::residual, page.before_m});
  residuals.push_back({page.improved ? "after" : "residual", Tone::improved, page.after_m});
  section.plots.push_back(present::spectrum_plot(page.record, residuals, page.noise_floor_m));
  section.plots.push_back(present::autocorrelation_plot(page.record, residuals));
}

Section section_of(const RecordPage& page, bool fitted, const std::string& heading) {
  Section section{.heading = heading};
  section.plots.push_back(position_plot(page, fitted));
  if (fitted) {
    section.paragraphs = {
        "The residuals are drift-corrected, those that the error above is the RMS of" +
            std::string(page.improved
                            ? ". Before: the model's own parameters fitted, nothing added; "
                              "after: the better model."
                            : ".") +
            " Against the motion stands where they arise: the force that the model lacks, or the "
            "speed "
            "by which it is off, from the residual's slope over 50 ms. A mean that leaves zero is "
            "physics that the model lacks. The first half second of each segment, while it "
            "settles, is "
            "left out.",
        present::kDynamicsMeaning};
    if (page.improved) {
      section.plots.push_back(
          residual_plot(page, "Residual before", page.before_m, Tone::residual));
      section.plots.push_back(residual_plot(page, "Residual after", page.after_m, Tone::improved));
    } else {
      section.plots.push_back(
          residual_plot(page, "Residual, model file as it is", page.file_m, Tone::residual));
      section.plots.push_back(
          residual_plot(page, "Residual, its parameters fitted", page.after_m, Tone::improved));
    }
  }
  section.plots.push_back(command_plot(page));
  if (fitted) {
    add_clouds(page, section);
    add_dynamics(page, section);
  }
  return section;
}

Residuals residuals_of(const DiagnosisReport& outcome) {
  Residuals all;
  if (!outcome.has_better_model()) return all;
  const selection::Diagnosis& d = outcome.diagnosis;
  const selection::DiagnosisProblem& problem = outcome.prepared->problem;
  const selection::ModelStage& before =
      d.search.path.empty() ? d.search.final : d.search.path.front();
  all.file_m = residual_of_file_m(problem, greybox::kObserver_per_s);
  all.before = greybox::with_values(problem.model, before.fitted);
  all.before_m = residual_of_m(problem, before.fitted, greybox::kObserver_per_s);
  all.after_m = residual_of_better_m(outcome, greybox::kObserver_per_s);
  all.free_file_m = residual_of_file_m(problem, 0.0);
  all.free_after_m = residual_of_better_m(outcome, 0.0);
  all.free_deviated_m = deviated_residuals_m(outcome, 0.0);
  return all;
}

}  // namespace

std::vector<Section> record_sections(const DiagnosisReport& outcome) {
  const greybox::FitDataset& data = outcome.prepared->problem.data;
  const Residuals all = residuals_of(outcome);
  std::vector<Section> sections;
  for (std::size_t r = 0; r < data.records.size(); ++r) {
    const greybox::Dataset& record = data.records[r];
    const std::size_t start = data.starts[r];
    const double noise_m = std::isfinite(data.noise_floor_m) ? data.noise_floor_m : 0.0;
    RecordPage page{.record = record,
                    .kinematics = greybox::kinematics(record, noise_m),
                    .file_m = counted_part(all.file_m, start, record),
                    .before_m = counted_part(all.before_m, start, record),
                    .after_m = counted_part(all.after_m, start, record),
                    .free_file_m = counted_part(all.free_file_m, start, record),
                    .free_after_m = counted_part(all.free_after_m, start, record),
                    .free_deviated_m = {},
                    .before = {},
                    .after = {},
                    .noise_floor_m = data.noise_floor_m,
                    .improved = outcome.diagnosis.adds_to_file()};
    for (Eigen::Index k = 0; k < all.free_deviated_m.cols(); ++k) {
      page.free_deviated_m.push_back(counted_part(all.free_deviated_m.col(k), start, record));
    }
    if (outcome.has_better_model()) {
      page.before = residual_source(all.before, record, page.before_m);
      page.after = residual_source(outcome.diagnosis.better, record, page.after_m);
    }
    const bool held_out = r >= outcome.prepared->records.size();
    sections.push_back(section_of(page, outcome.has_better_model(),
                                  (held_out ? "Held out: " : "Record ") + file_name(record.name)));
  }
  return sections;
}

}  // namespace workbench::diagnose
