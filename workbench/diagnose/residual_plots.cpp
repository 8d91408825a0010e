#include "workbench/diagnose/residual_plots.h"

#include <cmath>

#include "workbench/present/plot_data.h"
#include "workbench/present/record_section.h"

namespace workbench::diagnose {
namespace {

constexpr std::size_t kCloud = 1'500;

double mean_square_about_mean(const std::vector<double>& values) {
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    sum += value;
    squares += value * value;
    ++count;
  }
  return count > 0.0 ? squares / count - std::pow(sum / count, 2) : 0.0;
}

}  // namespace

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

std::vector<MotionVariable> motion_variables(const estimator::greybox::Dataset& record,
                                             const estimator::greybox::Kinematics& kinematics) {
  return {{{"velocity", "mm/s"}, scaled(kinematics.speed_mps, 1e3)},
          {{"position", "mm"}, scaled(record.y_m, 1e3)},
          {{"command", "V"}, record.u_V},
          {{"acceleration", "m/s²"}, kinematics.acceleration_mps2}};
}

present::Series cloud(const std::string& name, const std::vector<double>& x,
                      const std::vector<double>& y, present::Tone tone) {
  present::Series series{.name = name, .tone = tone, .kind = present::PlotKind::scatter};
  for (const std::size_t i : present::thin_cloud(x, y, kCloud)) {
    series.x.push_back(x[i]);
    series.y.push_back(y[i]);
  }
  return series;
}

present::Series mean_curve(const std::string& name, const std::vector<double>& x,
                           const std::vector<double>& y, present::Tone tone) {
  present::Series series = present::binned(x, y).mean;
  series.name = name;
  series.tone = tone;
  return series;
}

double shape_share(const std::vector<double>& x, const std::vector<double>& y) {
  const double whole = mean_square_about_mean(y);
  return whole > 0.0 ? mean_square_about_mean(present::binned(x, y).mean.y) / whole : 0.0;
}

}  // namespace workbench::diagnose
