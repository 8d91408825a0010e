#include "daemon/detection_config.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/snapshot.h"

namespace monitor {
namespace {

using config::schema::Visitor;

/// Files named by a configuration that go into each evidence folder.
struct NamedFile {
  const char* table;
  const char* key;
  const char* copy;
};
constexpr NamedFile kNamedFiles[] = {{"[sim]", "model", "model.toml"},
                                     {"", "bands_file", "bands.toml"},
                                     {"[model]", "file", "healthy_model.toml"},
                                     {"[rig]", "calibration", "calibration.toml"},
                                     {"[reference]", "file", "reference.csv"}};

/// The value of a text key in printed TOML; empty when the key is missing.
std::string text_of(const std::string& toml, const NamedFile& wanted) {
  std::istringstream lines(toml);
  std::string table;
  const std::string begin = std::string(wanted.key) + " = \"";
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('[')) table = line;
    if (table != wanted.table || !line.starts_with(begin)) continue;
    return line.substr(begin.size(), line.rfind('"') - begin.size());
  }
  return "";
}

std::string print(DaemonConfig& config) {
  return config::schema::print_toml([&](Visitor& v) { config.visit(v); });
}

/// Maps "[table] key" or "[[list]] id: key" to the printed value. List items without an id are
/// numbered.
std::map<std::string, std::string> flat(const std::string& toml) {
  std::map<std::string, std::string> values;
  std::map<std::string, int> items;
  std::istringstream lines(toml);
  std::string place;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[[")) {
      place = line + ' ' + std::to_string(++items[line]) + ": ";
      continue;
    }
    if (line.starts_with('[')) {
      place = line + ' ';
      continue;
    }
    const std::size_t equals = line.find(" = ");
    if (equals == std::string::npos) continue;
    const std::string key = line.substr(0, equals);
    const std::string value = line.substr(equals + 3);
    if (key == "id" && place.starts_with("[[") && value.size() > 2) {
      place = place.substr(0, place.find(']') + 3) + value.substr(1, value.size() - 2) + ": ";
    }
    values[place + key] = value;
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
  for (const auto& list : config.pipeline.sources) {
    for (const auto& item : list.items) {
      for (const std::string& input : item->inputs()) {
        check("[[" + std::string(list.kind.list) + "]] " + item->id, input);
      }
    }
  }
  for (const auto& band : config.pipeline.bands) check("[[band]] " + band.id, band.quantity);
}

}  // namespace

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
  if (!bands.empty() && !std::filesystem::is_regular_file(config.folder / bands, unknown)) {
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

std::vector<io::EvidenceFile> evidence_files(DaemonConfig& config,
                                             const std::string& pipeline_text) {
  const std::string toml = print(config);
  std::vector<io::EvidenceFile> files = {{"configuration.toml", toml},
                                         {"pipeline.toml", pipeline_text}};
  for (const NamedFile& wanted : kNamedFiles) {
    const std::string name = text_of(toml, wanted);
    if (name.empty()) continue;
    std::ifstream in(config.folder / name, std::ios::binary);
    if (!in) continue;
    std::ostringstream text;
    text << in.rdbuf();
    files.push_back({wanted.copy, text.str()});
  }
  return files;
}

std::vector<std::string> differences(DaemonConfig& before, DaemonConfig& after) {
  const auto old_values = flat(print(before));
  const auto new_values = flat(print(after));
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

bool may_change(const std::string& key, const estimator::fdi::PipelineConfig& pipeline) {
  if (key == "[alarms] folder" || key == "[alarms] audit_bytes") return false;
  return pipeline.owns(key) || key.starts_with("[alarms]") || key.starts_with("[model]");
}

}  // namespace monitor
