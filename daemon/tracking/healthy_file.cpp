#include "daemon/tracking/healthy_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/snapshot.h"

namespace monitor::tracking {
namespace {

using config::schema::bad_config;
using config::schema::Visitor;

/// Two sample times are the same within clock accuracy.
constexpr double kSameSampleTime = 1e-3;

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

}  // namespace

void HealthyFile::visit(Visitor& v) {
  v.text({"rig_id", "of the rig; empty: of any"}, rig_id);
  v.text({"model", "its name", true}, model);
  v.text({"fingerprint", "of the model and of the windows", true}, fingerprint);
  v.text({"source", "the healthy record"}, source);
  v.texts({"parameters", "tracked", true}, parameters);
  v.numbers({"values", "of the parameters, SI", true}, values);
  v.number({"sample_time_s", "of the record", true}, sample_time_s, {1e-6, 1e3});
  v.number({"rms_m", "of a healthy window's error", true}, rms_m, {1e-12, 1.0});
  v.number({"noise_floor_m", "of the position"}, noise_floor_m, {0.0, 1.0});
}

std::string fingerprint_of(const plant_sim::ModelFile& model, const Settings& settings) {
  const std::string whole = plant_sim::print_model(model) + text_of(settings.window_s) + ' ' +
                            text_of(settings.observer_per_s);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx",
                static_cast<unsigned long long>(estimator::fdi::hash_of(whole)));
  return text;
}

HealthyFile healthy_file(const plant_sim::ModelFile& model, const Choice& choice,
                         const Settings& settings, const Healthy& healthy) {
  HealthyFile file;
  file.model = model.name;
  file.fingerprint = fingerprint_of(model, settings);
  for (std::size_t i = 0; i < choice.tracked; ++i) {
    const SearchParameter& p = choice.parameters[i];
    file.parameters.push_back(p.name);
    file.values.push_back(p.value(healthy.x[static_cast<Eigen::Index>(i)]));
  }
  file.rms_m = healthy.rms_m;
  return file;
}

HealthyFile read_healthy(const std::filesystem::path& path, const plant_sim::ModelFile& model,
                         const Settings& settings, const Choice& choice, double sample_time_s,
                         const std::string& rig_id) {
  HealthyFile file;
  config::schema::Document::load(path).read([&](Visitor& v) { file.visit(v); });
  const std::string where = path.string();
  if (file.fingerprint != fingerprint_of(model, settings)) {
    throw bad_config(
        where,
        "was learnt with another model, window_s or observer_per_s (model " + file.model + ")",
        "one learnt with model " + model.name + " as it is, windows of " +
            text_of(settings.window_s) + " s, observer_per_s " + text_of(settings.observer_per_s));
  }
  if (!file.rig_id.empty() && !rig_id.empty() && file.rig_id != rig_id) {
    throw bad_config(where + ": rig_id", "is of another rig, " + file.rig_id, rig_id);
  }
  if (std::abs(file.sample_time_s - sample_time_s) > kSameSampleTime * sample_time_s) {
    throw bad_config(where + ": sample_time_s", "is " + text_of(file.sample_time_s) + " s",
                     text_of(sample_time_s));
  }
  if (file.values.size() != file.parameters.size()) {
    throw bad_config(where + ": values", "are not as many as parameters");
  }
  for (std::size_t i = 0; i < choice.tracked; ++i) {
    const std::string& name = choice.parameters[i].name;
    if (std::find(file.parameters.begin(), file.parameters.end(), name) == file.parameters.end()) {
      throw bad_config(where + ": parameters", "lack " + name, "all that are tracked");
    }
  }
  return file;
}

Healthy healthy_of(const HealthyFile& file, const Choice& choice) {
  Healthy healthy;
  healthy.rms_m = file.rms_m;
  healthy.x = choice.file;
  for (std::size_t i = 0; i < choice.tracked; ++i) {
    for (std::size_t j = 0; j < file.parameters.size(); ++j) {
      if (file.parameters[j] != choice.parameters[i].name) continue;
      healthy.x[static_cast<Eigen::Index>(i)] = choice.parameters[i].search(file.values[j]);
    }
  }
  return healthy;
}

}  // namespace monitor::tracking
