// session.json: what a session has open, kept between two runs of `serve`, and commands.sh beside
// it.
#pragma once

#include <string>
#include <vector>

#include "workbench/serve/lineage.h"
#include "workbench/serve/session_folder.h"

namespace workbench::serve {

struct SavedSession {
  std::string record, model, trial;  ///< file names; empty: none
  std::vector<std::string> ignored;  ///< "from:to", in s
  Lineage lineage;
};

/// Empty where there is none.
[[nodiscard]] SavedSession load_session(const SessionFolder& folder);

/// Throws config::schema::RunError where session.json cannot be written; a script that cannot is
/// named on standard error.
void save_session(const SessionFolder& folder, const SavedSession& session);

}  // namespace workbench::serve
