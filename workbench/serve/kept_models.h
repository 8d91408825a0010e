// Texts of the models that a session has shown, so that they can be written again where its folder
// was removed and made anew.
#pragma once

#include <map>
#include <string>

#include "workbench/serve/session_folder.h"

namespace workbench::serve {

class KeptModels {
 public:
  /// Reads a model's file; one that is not there, and an empty name, leave what is kept.
  void keep(const SessionFolder& folder, const std::string& model);
  /// Writes the models whose files are missing. Throws config::schema::RunError where that fails.
  void restore(const SessionFolder& folder) const;

 private:
  std::map<std::string, std::string> texts_;
};

}  // namespace workbench::serve
