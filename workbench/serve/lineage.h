// The models of a session: which came from which, by which command, and how large the error of
// each is on samples that were not fitted. session.json holds it; commands.sh holds the commands.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace workbench::serve {

struct ModelNode {
  std::string model;   ///< file name
  std::string parent;  ///< empty: a model that was opened
  std::string what;    ///< "as it is", "fitted", "+ friction"
  std::string record;  ///< that the errors are of; empty: not known yet
  double heldout_m = 0.0;
  double rms_m = 0.0;
  double noise_floor_m = 0.0;
  bool rotary = false;  ///< an axis that turns: its errors are angles
};

struct Lineage {
  std::vector<ModelNode> nodes;
  std::vector<std::string> commands;

  /// The node of a model; null where there is none.
  [[nodiscard]] ModelNode* find(const std::string& model);
  ModelNode& add(const std::string& model, const std::string& parent, const std::string& what);
  void remember(const std::string& command);
};

/// SI; a missing number is null.
[[nodiscard]] nlohmann::ordered_json to_json(const Lineage& lineage);
/// Leaves out what it does not understand.
[[nodiscard]] Lineage lineage_of(const nlohmann::ordered_json& json);
/// The commands as a script for a shell.
[[nodiscard]] std::string script_of(const Lineage& lineage);

}  // namespace workbench::serve
