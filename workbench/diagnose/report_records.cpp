// The sections of the report that hold each record against the model before and after.
#include <algorithm>
#include <cmath>

#include "config/signals/nan.h"
#include "estimator/greybox/kinematics.h"
#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/diagnose/model_residuals.h"
#include "workbench/diagnose/words.h"
#include "workbench/present/plot_data.h"
#include "workbench/present/record_section.h"

namespace workbench::diagnose {
namespace {

using present::Plot;
using present::PlotKind;
using present::Section;
using present::Series;
using present::Tone;

using config::signals::kNaN;
constexpr std::size_t kCloud = 2'500;
/// Residuals above this are drawn in millimetres.
constexpr double kMillimetres_m = 2e-3;

/// The long series of residuals, of all records.
struct Residuals {
  Eigen::VectorXd file_m, before_m, after_m, free_file_m, free_after_m;
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
      free_after_m;  ///< NaN where it does not count
  double noise_floor_m = kNaN;
  bool improved = false;  ///< something was added
};

std::vector<double> times(const std::vector<double>& values, double factor) {
  std::vector<double> out(values.size());
  std::transform(values.begin(), values.end(), out.begin(),
                 [factor](double value) { return factor * value; });
  return out;
}

std::vector<double> cut(const Eigen::VectorXd& series_m, std::size_t start,
                        const greybox::Dataset& record) {
  std::vector<double> out(record.size(), kNaN);
  if (series_m.size() == 0) return out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (record.valid[i] != 0) out[i] = series_m[static_cast<Eigen::Index>(start + i)];
  }
  return out;
}

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
                         .y = broken_at_gaps(times(page.record.y_m, 1e3), page.record),
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
  plot.series.push_back({.name = "residual", .y = times(residual_m, scale.per_m), .tone = tone});
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

Series mean_of(const std::string& name, const std::vector<double>& x, const std::vector<double>& y,
               Tone tone) {
  Series series = present::binned(x, y).mean;
  series.name = name;
  series.tone = tone;
  return series;
}

Series cloud(const std::string& name, const std::vector<double>& x, const std::vector<double>& y,
             Tone tone) {
  Series series{.name = name, .tone = tone};
  for (const std::size_t i : present::thin_cloud(x, y, kCloud)) {
    series.x.push_back(x[i]);
    series.y.push_back(y[i]);
  }
  return series;
}

Plot against(const RecordPage& page, const std::string& what, const std::string& unit,
             const std::vector<double>& x) {
  const ResidualScale scale = scale_of(page.before_m);
  const std::vector<double> before = times(page.before_m, scale.per_m);
  const std::vector<double> after = times(page.after_m, scale.per_m);
  Plot plot{.title = "Residual against " + what,
            .kind = PlotKind::scatter,
            .x = {what, unit},
            .y = {"measured − model", scale.unit},
            .width = present::PlotWidth::half};
  if (page.improved) {
    plot.series = {cloud("before", x, before, Tone::residual),
                   cloud("after", x, after, Tone::improved),
                   mean_of("before, mean", x, before, Tone::accent),
                   mean_of("after, mean", x, after, Tone::model)};
  } else {
    const present::Binned curves = present::binned(x, after);
    plot.series = {cloud("residual", x, after, Tone::residual), curves.mean, curves.rms};
  }
  return plot;
}

void add_clouds(const RecordPage& page, Section& section) {
  std::vector<double> speed = times(page.kinematics.speed_mps, 1e3);
  section.plots.push_back(against(page, "position", "mm", times(page.record.y_m, 1e3)));
  section.plots.push_back(against(page, "velocity", "mm/s", speed));
  section.plots.push_back(against(page, "command", "V", page.record.u_V));
  for (double& v : speed) v = std::abs(v);
  section.plots.push_back(against(page, "speed", "mm/s", speed));
  section.plots.push_back(against(page, "acceleration", "m/s²", page.kinematics.acceleration_mps2));
  section.plots.push_back(against(page, "time", "s", page.record.t_s));
}

Section section_of(const RecordPage& page, bool fitted, const std::string& heading) {
  Section section{.heading = heading};
  section.plots.push_back(position_plot(page, fitted));
  if (fitted) {
    section.paragraphs = {
        "The residuals are drift-corrected, those that the error above is the RMS of" +
        std::string(page.improved ? ". Before: the model's own parameters fitted, nothing added; "
                                    "after: the better model."
                                  : ".") +
        " Point clouds show an even selection of the samples and their outline; a curve that "
        "leaves zero is physics that the model lacks."};
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
  if (fitted) add_clouds(page, section);
  return section;
}

Residuals residuals_of(const DiagnosisReport& outcome) {
  Residuals all;
  if (!outcome.fitted()) return all;
  const selection::Diagnosis& d = outcome.diagnosis;
  const selection::DiagnosisProblem& problem = outcome.prepared->problem;
  const selection::ModelStage& before =
      d.search.rounds.empty() ? d.search.final : d.search.rounds.front().before;
  all.file_m = residual_of_file_m(problem, greybox::kObserver_per_s);
  all.before_m = residual_of_m(problem, before.fitted, greybox::kObserver_per_s);
  all.after_m = residual_of_better_m(outcome, greybox::kObserver_per_s);
  all.free_file_m = residual_of_file_m(problem, 0.0);
  all.free_after_m = residual_of_better_m(outcome, 0.0);
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
    const RecordPage page{.record = record,
                          .kinematics = greybox::kinematics(record, noise_m),
                          .file_m = cut(all.file_m, start, record),
                          .before_m = cut(all.before_m, start, record),
                          .after_m = cut(all.after_m, start, record),
                          .free_file_m = cut(all.free_file_m, start, record),
                          .free_after_m = cut(all.free_after_m, start, record),
                          .noise_floor_m = data.noise_floor_m,
                          .improved = !outcome.diagnosis.missing.empty()};
    const bool held_out = r >= outcome.prepared->records.size();
    sections.push_back(section_of(page, outcome.fitted(),
                                  (held_out ? "Held out: " : "Record ") + file_name(record.name)));
  }
  return sections;
}

}  // namespace workbench::diagnose
