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

struct LoadedSession {
  SavedSession session;  ///< empty where there is none
  std::string notice;    ///< why it is not the saved one, and where that is kept; empty: it is
};

/// A session.json that cannot be read is set aside under another name, with commands.sh, so that
/// no change overwrites them. Throws config::schema::RunError where that fails.
[[nodiscard]] LoadedSession load_session(const SessionFolder& folder);

/// False where session.json is missing, as in a folder that was made anew.
[[nodiscard]] bool session_is_there(const SessionFolder& folder);

/// Throws config::schema::RunError where session.json cannot be written; a script that cannot is
/// named on standard error.
void save_session(const SessionFolder& folder, const SavedSession& session);

}  // namespace workbench::serve
