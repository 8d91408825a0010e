#include "daemon/detection_config.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/flat_visitor.h"
#include "config/schema/read_file.h"
#include "daemon/control/guard_limits.h"
#include "estimator/fdi/snapshot.h"

namespace monitor {
namespace {

using config::schema::Visitor;

std::vector<config::schema::FlatTable> flatten(DaemonConfig& config) {
  return config::schema::flatten([&](Visitor& v) { config.visit(v); });
}

/// Maps "[table] key" or "[[list]] id: key" to the printed value. List items without an id are
/// numbered.
std::map<std::string, std::string> values_by_key(DaemonConfig& config) {
  std::map<std::string, std::string> values;
  std::map<std::string, int> items;
  for (const config::schema::FlatTable& table : flatten(config)) {
    std::string place = table.name.empty() ? "" : table.header() + ' ';
    if (table.element) place += std::to_string(++items[table.name]) + ": ";
    for (const config::schema::FlatField& field : table.fields) {
      if (field.key == "id" && table.element && field.value.size() > 2) {
        place = table.header() + ' ' + field.value.substr(1, field.value.size() - 2) + ": ";
      }
      values[place + field.key] = field.value;
    }
  }
  return values;
}

/// The hardware that the rig lacks for a sample quantity; empty when the rig provides the quantity.
/// A single rod sensor is the sample's y_m.
std::string lacking(const hal::Rig& rig, const std::string& quantity) {
  const std::size_t rods = rig.rods() > 1 ? rig.rods() : 0;
  if (estimator::fdi::rod_of(quantity) > rods) {
    return rods == 0 ? "a [[spare_rod]]; a single sensor is sample.y_m"
                     : "sample.rod_1_m to sample.rod_" + std::to_string(rods) + "_m";
  }
  for (const char* role : {"supply_pressure", "pressure_in", "pressure_out"}) {
    if (quantity != "sample." + std::string(role) + "_Pa") continue;
    for (const hal::InputConfig& input : rig.inputs()) {
      if (input.role == role) return {};
    }
    return "an [[input]] of role \"" + std::string(role) + "\"";
  }
  return {};
}

/// Throws when an estimator or band reads a sensor that the rig does not have.
void check_sensors(const DaemonConfig& config) {
  const auto check = [&](const std::string& where, const std::string& quantity) {
    const std::string needed = lacking(config.rig, quantity);
    if (needed.empty()) return;
    throw config::schema::bad_config(config.file + ": " + where,
                                     "reads " + quantity + ", which the rig does not have", needed);
  };
  for (const auto& list : config.pipeline.methods) {
    for (const auto& item : list.items) {
      for (const std::string& input : item->inputs()) {
        check("[[" + std::string(list.kind.list) + "]] " + item->id, input);
      }
    }
  }
  for (const auto& band : config.pipeline.bands) check("[[band]] " + band.id, band.quantity);
  for (const auto& guard : config.safety.guards) {
    const std::string where = "[[guard]] " + guard.id;
    if (!guard.channel.empty()) check(where + " channel", "sample." + guard.channel + "_Pa");
    if (guard.which() != control::GuardKind::chambers) continue;
    check(where, "sample.pressure_in_Pa");
    check(where, "sample.pressure_out_Pa");
  }
}

bool is_open(const estimator::fdi::BandConfig& band) {
  return std::isinf(band.low) && std::isinf(band.high);
}

}  // namespace

std::string unlearned_bands(const DaemonConfig& config) {
  std::error_code unknown;
  const std::string& bands = config.pipeline.bands_file;
  if (bands.empty() || std::filesystem::exists(config.folder / bands, unknown)) return "";
  std::string names;
  for (const auto& band : config.pipeline.bands) {
    if (is_open(band)) names += (names.empty() ? "" : ", ") + band.id;
  }
  return names;
}

DetectionConfig make_detection_config(const DaemonConfig& config, double sample_time_s) {
  DetectionConfig made;
  made.effective = config.pipeline;
  check_sensors(config);
  std::error_code unknown;
  if (!config.model.empty() &&
      !std::filesystem::is_regular_file(config.folder / config.model, unknown)) {
    throw config::schema::bad_config(config.file + ": [model] file: " + config.model,
                                     "does not exist", "a model file (TOML)");
  }
  const std::string& bands = made.effective.bands_file;
  const bool waits = std::any_of(made.effective.bands.begin(), made.effective.bands.end(),
                                 [](const auto& band) { return is_open(band); });
  if (!bands.empty() && !waits &&
      !std::filesystem::is_regular_file(config.folder / bands, unknown)) {
    throw config::schema::bad_config(
        config.file + ": bands_file: " + (config.folder / bands).string(), "does not exist",
        "a file of learned bands (TOML)");
  }
  with_place(config.file,
             [&] { made.effective.load_bands(config.folder, sample_time_s, config.rig_id); });
  made.pipeline = with_place(config.file, [&] {
    return std::make_unique<estimator::fdi::Pipeline>(made.effective, sample_time_s);
  });
  made.pipeline->alarms().set_condition_rules(config.alarms.rules);
  made.text = estimator::fdi::whole_text(made.effective, sample_time_s);
  return made;
}

namespace {

/// The configuration without the places of this machine: of an absolute path its last name.
std::string portable_text(DaemonConfig& config) {
  std::vector<config::schema::FlatTable> tables = flatten(config);
  for (config::schema::FlatTable& table : tables) {
    for (config::schema::FlatField& field : table.fields) {
      if (!std::filesystem::path(field.path).is_absolute()) continue;
      std::string value = field.value;  // quoted
      while (value.ends_with("/\"")) value.erase(value.size() - 2, 1);
      const std::size_t slash = value.rfind('/');
      field.value = "\"" + value.substr(slash == std::string::npos ? 1 : slash + 1);
    }
  }
  return config::schema::print_toml(tables);
}

}  // namespace

std::vector<io::EvidenceFile> evidence_files(DaemonConfig& config,
                                             const std::string& pipeline_text) {
  std::vector<io::EvidenceFile> files = {{"configuration.toml", portable_text(config)},
                                         {"pipeline.toml", pipeline_text}};
  for (const config::schema::FlatTable& table : flatten(config)) {
    for (const config::schema::FlatField& field : table.fields) {
      if (field.path.empty() || field.evidence_copy.empty()) continue;
      config::schema::FileContent content = config::schema::read_file(
          config.folder / field.path, config::schema::kMostConfigurationBytes);
      if (!content.wrong.empty()) continue;
      files.push_back({field.evidence_copy, std::move(content.text)});
    }
  }
  return files;
}

std::vector<std::string> differences(DaemonConfig& before, DaemonConfig& after) {
  const auto old_values = values_by_key(before);
  const auto new_values = values_by_key(after);
  std::vector<std::string> keys;
  for (const auto& [key, value] : old_values) {
    const auto found = new_values.find(key);
    if (found == new_values.end() || found->second != value) keys.push_back(key);
  }
  for (const auto& [key, value] : new_values) {
    if (!old_values.contains(key)) keys.push_back(key);
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

bool is_guard_limit(const std::string& key) {
  const std::size_t end = key.rfind(": ");
  return key.starts_with("[[guard]] ") && end != std::string::npos &&
         control::is_guard_limit(std::string_view(key).substr(end + 2));
}

bool may_change(const std::string& key, const estimator::fdi::PipelineConfig& pipeline) {
  if (key == "[alarms] folder" || key == "[alarms] audit_bytes") return false;
  return pipeline.owns(key) || is_guard_limit(key) || key.starts_with("[alarms]") ||
         key.starts_with("[model]");
}

}  // namespace monitor
