#include "workbench/laws/laws.h"

#include <algorithm>
#include <cmath>

#include "config/units/quantity.h"
#include "workbench/laws/steady_motion.h"
#include "workbench/present/record_section.h"

namespace workbench::laws {
namespace {

namespace validation = estimator::greybox::validation;
using plant_sim::ModelFile;

constexpr std::size_t kCommands = 64;
constexpr std::size_t kMostSamples = 1200;
constexpr double kMillimetres = 1e3;

/// Evenly from the least to the greatest command of the record.
std::vector<double> commands_of(const std::vector<double>& u_V) {
  const auto [least, most] = std::minmax_element(u_V.begin(), u_V.end());
  std::vector<double> commands;
  for (std::size_t i = 0; i < kCommands; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(kCommands - 1);
    commands.push_back(*least + share * (*most - *least));
  }
  return commands;
}

/// Every n-th sample, so that the page draws no more than kMostSamples.
void thin(LawCurve& curve) {
  const std::size_t every = curve.x.size() / kMostSamples + 1;
  LawCurve kept;
  for (std::size_t i = 0; i < curve.x.size(); i += every) {
    kept.x.push_back(curve.x[i]);
    kept.y.push_back(curve.y[i]);
  }
  curve = std::move(kept);
}

void take_mean(Law& law) {
  const present::Binned binned = present::binned(law.samples.x, law.samples.y);
  law.mean = {binned.mean.x, binned.mean.y};
  thin(law.samples);
}

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

double median_of_sizes(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// In steady motion the speed is that of the flow.
Law flow_law(const SteadyMotion& steady, const validation::Comparison& c) {
  Law law;
  law.title = "Speed over command";
  law.x_name = "command";
  law.x_unit = "V";
  law.y_name = "speed";
  law.y_unit = config::units::axis_unit("mm/s");
  law.model = {steady.command_V, scaled(steady.speed_mps, kMillimetres)};
  const double calm_mps2 = median_of_sizes(c.kinematics.acceleration_mps2);
  for (std::size_t k = 0; k < c.record.size(); ++k) {
    if (std::abs(c.kinematics.acceleration_mps2[k]) > calm_mps2) continue;
    law.samples.x.push_back(c.record.u_V[k]);
    law.samples.y.push_back(kMillimetres * c.kinematics.speed_mps[k]);
  }
  law.note = "the half of the samples that accelerates least";
  take_mean(law);
  return law;
}

/// What the drive gives beyond the inertia's share resists.
Law force_law(const ModelFile& model, const SteadyMotion& steady, const validation::Comparison& c) {
  ModelFile copy = model;
  Law law;
  law.title = config::units::axis_words("Resisting force over speed");
  law.x_name = "speed";
  law.x_unit = config::units::axis_unit("mm/s");
  law.y_name = config::units::axis_words("force");
  law.y_unit = config::units::axis_unit("N");
  law.model = {scaled(steady.speed_mps, kMillimetres), steady.force_N};
  const double* const gain_N_per_V = copy.value("gain_N_per_V");
  if (gain_N_per_V == nullptr) {
    law.note = "the model's alone: command and position do not show a force";
    return law;
  }
  const double mass_kg = *copy.value("mass_kg");
  for (std::size_t k = 0; k < c.record.size(); ++k) {
    law.samples.x.push_back(kMillimetres * c.kinematics.speed_mps[k]);
    law.samples.y.push_back(*gain_N_per_V * c.record.u_V[k] -
                            mass_kg * c.kinematics.acceleration_mps2[k]);
  }
  law.note = config::units::axis_words("command times gain, less mass times acceleration");
  take_mean(law);
  return law;
}

}  // namespace

std::vector<Law> laws_of(const ModelFile& model, const validation::Comparison& compared) {
  const SteadyMotion steady = steady_motion(model, commands_of(compared.record.u_V));
  std::vector<Law> laws;
  ModelFile copy = model;
  // The speed of an axis driven by a force follows its command only in the long run.
  if (copy.value("gain_N_per_V") == nullptr) laws.push_back(flow_law(steady, compared));
  const bool force = std::any_of(steady.force_N.begin(), steady.force_N.end(),
                                 [](double f_N) { return std::isfinite(f_N); });
  if (force) laws.push_back(force_law(model, steady, compared));
  return laws;
}

}  // namespace workbench::laws
