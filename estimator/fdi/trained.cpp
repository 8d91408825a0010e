#include "estimator/fdi/trained.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "estimator/fdi/pipeline_config.h"
#include "estimator/fdi/quantity.h"
#include "estimator/fdi/snapshot.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_config;
using config::schema::joined;
using config::schema::Visitor;

std::string seconds(double s) { return fmt::format("{:.6g} s", s); }

/// `at`: chain of methods visited; circular reads are refused elsewhere.
std::string settings_behind(std::string_view source, const PipelineConfig& pipeline,
                            const std::string& quantity, const std::string& where,
                            std::vector<std::string_view>& at) {
  std::string settings = pipeline.fingerprint(source);
  const DetectionMethodConfig* const config = pipeline.find_method(source);
  if (config == nullptr || std::find(at.begin(), at.end(), source) != at.end()) return settings;
  if (dynamic_cast<const TrainedMethodConfig*>(config) != nullptr) {
    throw bad_config(where, "cannot be trained on " + quantity + ", which is trained itself",
                     "values of estimators and of the sample");
  }
  at.push_back(source);
  for (const std::string& input : config->inputs()) {
    const std::string behind =
        settings_behind(split_quantity(input).source, pipeline, quantity, where, at);
    if (!behind.empty()) settings += " | " + behind;
  }
  at.pop_back();
  return settings;
}

}  // namespace

void TrainedClass::visit(Visitor& v) {
  v.text({"name", "healthy, or the changed parameter", true}, name);
  v.integer({"direction", "direction of the change"}, direction, {-1, 1});
  v.integer({"blocks", "number of blocks it was learned from", true}, blocks, {2, 1'000'000'000});
  v.numbers({"mean", "mean of the block means", true}, mean);
  v.numbers({"covariance", "covariance of the block means, row by row", true}, covariance);
  v.numbers({"long_run", "long-run standard deviations, autocorrelation included", true}, long_run);
}

void TrainedMethod::visit(Visitor& v) {
  v.text({"id", "id of the detection method", true}, id);
  v.texts({"quantities", "quantities of the training"}, quantities);
  v.texts({"settings", "settings of each quantity's source"}, settings);
  v.number({"block_s", "length of the blocks", true}, block_s, {0.0, 1e6});
  config::schema::visit_list(v, {"class", "kinds of records"}, classes);
}

const TrainedClass* TrainedMethod::healthy() const noexcept {
  for (const TrainedClass& each : classes) {
    if (each.name == TrainedFile::kHealthy) return &each;
  }
  return nullptr;
}

void TrainedFile::visit(Visitor& v) {
  v.integer({"trained_version", "layout of this file", true}, version, {kVersion, kVersion});
  v.text({"units", "units of position, command and time", true}, units);
  v.text({"rig_id", "id of the rig", true}, rig_id);
  v.number({"sample_time_s", "sample time of the records", true}, sample_time_s, {1e-6, 1e3});
  v.texts({"records", "records of the training"}, records);
  config::schema::visit_list(v, {"trained", "detection methods trained here"}, methods);
}

void TrainedMethodConfig::visit_trained(Visitor& v) {
  v.text({"id", "name; prefix of its values: ID.name", true}, id);
  v.number({"block_s", "averaging time of the values; 0: no averaging"}, block_s, {0.0, 1e6});
  v.text({"file", "file of spoolwatch train, relative to this file's folder"}, file);
}

void TrainedMethodConfig::load(const ConfigLoadContext& context) {
  if (file.empty()) return;
  const std::string name = (context.folder / file).string();
  TrainedFile trained;
  config::schema::Document::load(name).read([&](Visitor& v) { trained.visit(v); });
  if (trained.units != TrainedFile::kUnits) {
    throw bad_config(name + ": units", "was trained in '" + trained.units + "'",
                     TrainedFile::kUnits);
  }
  if (!context.rig_id.empty() && context.rig_id != trained.rig_id) {
    throw bad_config(
        name + ": rig_id",
        "was trained on rig '" + trained.rig_id + "', this is '" + context.rig_id + "'",
        "a file trained on this rig");
  }
  if (std::abs(trained.sample_time_s - context.sample_time_s) >
      kSameSampleTime_ratio * context.sample_time_s) {
    throw bad_config(name + ": sample_time_s",
                     "was trained at " + seconds(trained.sample_time_s) +
                         ", the samples come every " + seconds(context.sample_time_s),
                     "a file trained at the same sample time");
  }
  for (const TrainedMethod& source : trained.methods) {
    if (source.id != id) continue;
    const std::string place = name + ": [[trained]] " + id;
    check(source, context, place);
    const std::size_t size = quantities().size();
    for (const TrainedClass& each : source.classes) {
      if (each.mean.size() == size && each.long_run.size() == size &&
          each.covariance.size() == size * size) {
        continue;
      }
      throw bad_config(place, "class " + each.name + " has not a number for each quantity");
    }
    if (source.healthy() == nullptr) throw bad_config(place, "has no class healthy");
    adopt(source);
    file.clear();
    return;
  }
  throw bad_config(name, "has no entry for " + where(), "train again");
}

void TrainedMethodConfig::check(const TrainedMethod& trained, const ConfigLoadContext& context,
                                const std::string& place) const {
  if (trained.quantities != quantities()) {
    throw bad_config(place, "was trained on " + joined(trained.quantities), joined(quantities()));
  }
  if (trained.block_s != block_s) {
    throw bad_config(place, "was trained on blocks of " + seconds(trained.block_s),
                     "block_s of " + where() + ", " + seconds(block_s));
  }
  const std::vector<std::string> settings = settings_of(quantities(), context.pipeline, where());
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const std::string found = i < trained.settings.size() ? trained.settings[i] : "";
    if (found == settings[i]) continue;
    const FingerprintDifference differs = difference(found, settings[i]);
    throw bad_config(place,
                     trained.quantities[i] + " was trained with other settings: " + differs.found,
                     differs.expected);
  }
}

std::vector<std::string> settings_of(const std::vector<std::string>& quantities,
                                     const PipelineConfig& pipeline, const std::string& where) {
  std::vector<std::string> settings;
  for (const std::string& quantity : quantities) {
    std::vector<std::string_view> at;
    settings.push_back(
        settings_behind(split_quantity(quantity).source, pipeline, quantity, where, at));
  }
  return settings;
}

void AlarmNaming::visit(Visitor& v) {
  v.choice({"severity", "severity of its alarm"}, severity, {"minor", "major"});
  v.text({"guidance", "advice to the operator"}, guidance);
  rules.visit(v);
}

Alarm AlarmNaming::alarm(std::string name) const {
  Alarm alarm;
  alarm.name = std::move(name);
  alarm.guidance = guidance;
  alarm.rules = rules;
  return alarm;
}

}  // namespace estimator::fdi
