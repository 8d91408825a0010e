#include "workbench/serve/session_file.h"

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "config/schema/read_file.h"

namespace workbench::serve {
namespace {

using nlohmann::ordered_json;

constexpr const char* kSession = "session.json";
constexpr const char* kScript = "commands.sh";

constexpr std::size_t kMostSessionBytes = 16 * config::schema::kMiB;

bool is_of(const ordered_json& session, const char* key, ordered_json::value_t type) {
  const auto found = session.find(key);
  return found == session.end() || found->type() == type;
}

/// What is wrong with a session's text, in a few words; empty: nothing.
std::string damage_of(const ordered_json& session) {
  if (session.is_discarded()) return "is no JSON";
  if (!session.is_object()) return "is no JSON object";
  for (const char* key : {"record", "model", "trial"}) {
    if (!is_of(session, key, ordered_json::value_t::string))
      return std::string(key) + " is no text";
  }
  for (const char* key : {"ignored", "nodes", "commands"}) {
    if (!is_of(session, key, ordered_json::value_t::array)) return std::string(key) + " is no list";
  }
  return "";
}

SavedSession session_of(const ordered_json& session) {
  SavedSession saved;
  saved.record = session.value("record", "");
  saved.model = session.value("model", "");
  saved.trial = session.value("trial", "");
  saved.lineage = lineage_of(session);
  for (const ordered_json& span : session.value("ignored", ordered_json::array())) {
    if (span.is_string()) saved.ignored.push_back(span.get<std::string>());
  }
  return saved;
}

/// Gives a file of the folder a name that no change writes to; the name. Throws
/// config::schema::RunError.
std::string set_aside(const SessionFolder& folder, const std::string& name,
                      const std::string& aside, const std::string& why) {
  std::string kept = folder.fresh_name(aside);
  std::error_code error;
  std::filesystem::rename(folder.path_of(name), folder.path_of(kept), error);
  if (error) {
    throw config::schema::RunError(folder.path_of(name) + ": " + why +
                                   ", and cannot be set aside (" + error.message() +
                                   "); move it, or serve another --folder");
  }
  return kept;
}

bool is_there(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::symlink_status(file, ignored).type() !=
         std::filesystem::file_type::not_found;
}

}  // namespace

LoadedSession load_session(const SessionFolder& folder) {
  if (!is_there(folder.path_of(kSession))) return {};
  const config::schema::FileContent file =
      config::schema::read_file(folder.path_of(kSession), kMostSessionBytes);
  std::string why = file.wrong.empty() ? "" : "cannot be read (" + file.wrong + ")";
  if (why.empty()) {
    const ordered_json session = ordered_json::parse(file.text, nullptr, false);
    why = damage_of(session);
    if (why.empty()) return {session_of(session), ""};
  }
  LoadedSession loaded;
  loaded.notice = std::string(kSession) + ": " + why +
                  "; the session begins anew, the file is kept as " +
                  set_aside(folder, kSession, "session-damaged.json", why);
  if (is_there(folder.path_of(kScript))) {
    loaded.notice += ", the commands as " +
                     set_aside(folder, kScript, "commands-before.sh", "would be overwritten");
  }
  return loaded;
}

bool session_is_there(const SessionFolder& folder) { return is_there(folder.path_of(kSession)); }

void save_session(const SessionFolder& folder, const SavedSession& saved) {
  ordered_json session{{"record", saved.record},
                       {"model", saved.model},
                       {"trial", saved.trial},
                       {"ignored", saved.ignored}};
  session.update(to_json(saved.lineage));
  config::record::write_whole(
      folder.path_of(kSession),
      session.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
  try {
    config::record::write_whole(folder.path_of(kScript), script_of(saved.lineage));
  } catch (const config::schema::Error& error) {
    // The session is saved, and the next change writes the whole script.
    std::cerr << "spoolwatch serve: " << error.what() << '\n';
  }
}

}  // namespace workbench::serve
