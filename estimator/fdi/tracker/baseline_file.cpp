#include "estimator/fdi/tracker/baseline_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "estimator/fdi/snapshot.h"

namespace estimator::fdi::tracker {
namespace {

using config::schema::bad_config;
using config::schema::Visitor;

/// Relative difference up to which two sample times are equal.
constexpr double kSameSampleTime = 1e-3;

std::string text_of(double value) { return fmt::format("{:.9g}", value); }

std::vector<std::string> sorted(std::vector<std::string> names) {
  std::sort(names.begin(), names.end());
  return names;
}

/// Throws when the value learned differs from the value expected.
void compare(const std::string& where, double found, double expected, const char* unit) {
  if (text_of(found) == text_of(expected)) return;
  throw bad_config(where, "was learned with " + text_of(found) + unit, text_of(expected) + unit);
}

}  // namespace

void BaselineFile::visit(Visitor& v) {
  v.integer({"healthy_version", "layout of this file", true}, version, {kVersion, kVersion});
  v.text({"rig_id", "id of the rig; empty: any"}, rig_id);
  v.text({"model", "name of the model", true}, model);
  v.text({"model_values", "all that the model is", true}, model_values);
  v.text({"source", "the healthy record"}, source);
  v.texts({"parameters", "tracked", true}, parameters);
  v.numbers({"values", "values of the parameters, SI", true}, values);
  v.number({"sample_time_s", "sample time of the record", true}, sample_time_s, {1e-6, 1e3});
  v.number({"window_s", "length of the windows", true}, window_s, {1e-6, 1e6});
  v.number({"observer_per_s", "gain that corrected the simulated position", true}, observer_per_s,
           {0.0, 1e3});
  v.number({"rms_m", "RMS error of a healthy window", true}, rms_m, {1e-12, 1.0});
  v.number({"noise_floor_m", "noise floor of the position"}, noise_floor_m, {0.0, 1.0});
  chambers.visit(v);
  visit_disturbance(v);
}

void BaselineFile::visit_disturbance(Visitor& v) {
  bool disturbed = noise.has_value();
  v.optional_table({"disturbance", "what disturbs the healthy rig's process"}, disturbed,
                   [&](Visitor& table) {
                     if (!noise) noise.emplace();
                     noise->visit(table);
                   });
  if (!disturbed) noise.reset();
}

std::string values_line(const plant_sim::ModelFile& model) {
  return estimator::fdi::one_line(plant_sim::print_model(model));
}

BaselineFile baseline_file(const plant_sim::ModelFile& model,
                           const greybox::tracking::ParameterSet& set,
                           const greybox::tracking::TrackerSettings& settings,
                           const greybox::tracking::Baseline& baseline) {
  BaselineFile file;
  file.model = model.name;
  file.model_values = values_line(model);
  file.window_s = settings.window_s;
  file.observer_per_s = settings.observer_per_s;
  for (std::size_t i = 0; i < set.tracked; ++i) {
    const greybox::FreeParameter& p = set.parameters[i];
    file.parameters.push_back(p.name);
    file.values.push_back(p.to_physical(baseline.theta[static_cast<Eigen::Index>(i)]));
  }
  file.rms_m = baseline.rms_m;
  file.chambers = baseline.chambers;
  file.noise = baseline.noise;
  return file;
}

BaselineFile read_baseline(const std::filesystem::path& path, const plant_sim::ModelFile& model,
                           const greybox::tracking::TrackerSettings& settings,
                           const greybox::tracking::ParameterSet& set, double sample_time_s,
                           const std::string& rig_id) {
  BaselineFile file;
  config::schema::Document::load(path).read([&](Visitor& v) { file.visit(v); });
  const std::string where = path.string();
  const std::string values = values_line(model);
  if (file.model_values != values) {
    const auto differs = estimator::fdi::difference(file.model_values, values);
    throw bad_config(where + ": model_values",
                     "was learned with another model, " + file.model + ": " + differs.found,
                     "model " + model.name + ": " + differs.expected);
  }
  compare(where + ": window_s", file.window_s, settings.window_s, " s");
  compare(where + ": observer_per_s", file.observer_per_s, settings.observer_per_s, " 1/s");
  if (!file.rig_id.empty() && !rig_id.empty() && file.rig_id != rig_id) {
    throw bad_config(where + ": rig_id", "is of another rig, " + file.rig_id, rig_id);
  }
  if (std::abs(file.sample_time_s - sample_time_s) > kSameSampleTime * sample_time_s) {
    throw bad_config(where + ": sample_time_s", "is " + text_of(file.sample_time_s) + " s",
                     text_of(sample_time_s) + " s");
  }
  if (file.values.size() != file.parameters.size()) {
    throw bad_config(where + ": values", "are not as many as parameters");
  }
  std::vector<std::string> tracked;
  for (std::size_t i = 0; i < set.tracked; ++i) tracked.push_back(set.parameters[i].name);
  const auto size = static_cast<Eigen::Index>(set.tracked);
  if (file.noise && file.noise->covariance.rows() != size) {
    throw bad_config(where + ": disturbance.covariance", "is not of as many parameters");
  }
  if (sorted(file.parameters) != sorted(tracked)) {
    throw bad_config(
        where + ": parameters",
        "was learned while " + config::schema::joined(file.parameters) + " were tracked",
        config::schema::joined(tracked));
  }
  return file;
}

greybox::tracking::Baseline baseline_of(const BaselineFile& file,
                                        const greybox::tracking::ParameterSet& set) {
  greybox::tracking::Baseline baseline;
  baseline.rms_m = file.rms_m;
  baseline.chambers = file.chambers;
  baseline.theta = set.file;
  Eigen::VectorXi order = Eigen::VectorXi::LinSpaced(static_cast<Eigen::Index>(set.tracked), 0,
                                                     static_cast<int>(set.tracked) - 1);
  for (std::size_t i = 0; i < set.tracked; ++i) {
    for (std::size_t j = 0; j < file.parameters.size(); ++j) {
      if (file.parameters[j] != set.parameters[i].name) continue;
      order[static_cast<Eigen::Index>(i)] = static_cast<int>(j);
      baseline.theta[static_cast<Eigen::Index>(i)] = set.parameters[i].to_theta(file.values[j]);
    }
  }
  if (file.noise) {
    baseline.noise = file.noise;
    baseline.noise->covariance = file.noise->covariance(order, order).eval();
  }
  return baseline;
}

}  // namespace estimator::fdi::tracker
