#include "workbench/serve/lineage.h"

#include <algorithm>

#include "config/signals/nan.h"
#include "workbench/present/json.h"

namespace workbench::serve {
namespace {

using nlohmann::ordered_json;
using present::number_or_null;

constexpr std::size_t kMostCommands = 1000;

std::string stored_text(const ordered_json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

double stored_number(const ordered_json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : config::signals::kNaN;
}

}  // namespace

ModelNode* Lineage::find(const std::string& model) {
  const auto node = std::find_if(nodes.begin(), nodes.end(),
                                 [&](const ModelNode& one) { return one.model == model; });
  return node == nodes.end() ? nullptr : &*node;
}

ModelNode& Lineage::add(const std::string& model, const std::string& parent,
                        const std::string& what) {
  if (ModelNode* const known = find(model)) return *known;
  nodes.push_back({model, parent, what, "", config::signals::kNaN, config::signals::kNaN,
                   config::signals::kNaN, false});
  return nodes.back();
}

void Lineage::remember(const std::string& command) {
  if (!commands.empty() && commands.back() == command) return;
  commands.push_back(command);
  if (commands.size() > kMostCommands) commands.erase(commands.begin());
}

ordered_json to_json(const Lineage& lineage) {
  ordered_json nodes = ordered_json::array();
  for (const ModelNode& node : lineage.nodes) {
    nodes.push_back({{"model", node.model},
                     {"parent", node.parent},
                     {"what", node.what},
                     {"record", node.record},
                     {"heldout_m", number_or_null(node.heldout_m)},
                     {"rms_m", number_or_null(node.rms_m)},
                     {"noise_floor_m", number_or_null(node.noise_floor_m)},
                     {"rotary", node.rotary}});
  }
  return {{"nodes", nodes}, {"commands", lineage.commands}};
}

Lineage lineage_of(const ordered_json& json) {
  Lineage lineage;
  if (!json.is_object()) return lineage;
  if (const auto nodes = json.find("nodes"); nodes != json.end() && nodes->is_array()) {
    for (const ordered_json& one : *nodes) {
      if (!one.is_object() || stored_text(one, "model").empty()) continue;
      ModelNode& node = lineage.add(stored_text(one, "model"), stored_text(one, "parent"),
                                    stored_text(one, "what"));
      node.record = stored_text(one, "record");
      node.heldout_m = stored_number(one, "heldout_m");
      node.rms_m = stored_number(one, "rms_m");
      node.noise_floor_m = stored_number(one, "noise_floor_m");
      if (const auto rotary = one.find("rotary"); rotary != one.end() && rotary->is_boolean()) {
        node.rotary = rotary->get<bool>();
      }
    }
  }
  if (const auto commands = json.find("commands"); commands != json.end() && commands->is_array()) {
    for (const ordered_json& one : *commands) {
      if (one.is_string()) lineage.remember(one.get<std::string>());
    }
  }
  return lineage;
}

std::string script_of(const Lineage& lineage) {
  std::string script = "#!/bin/sh\n# What was done in this folder, in order.\nset -e\n";
  for (const std::string& command : lineage.commands) script += command + "\n";
  return script;
}

}  // namespace workbench::serve
