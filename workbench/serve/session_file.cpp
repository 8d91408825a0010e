#include "workbench/serve/session_file.h"

#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "config/record/whole_file.h"
#include "config/schema/error.h"

namespace workbench::serve {
namespace {

using nlohmann::ordered_json;

constexpr const char* kSession = "session.json";
constexpr const char* kScript = "commands.sh";

}  // namespace

SavedSession load_session(const SessionFolder& folder) {
  SavedSession saved;
  std::ifstream in(folder.path_of(kSession));
  const ordered_json session = ordered_json::parse(in, nullptr, false);
  if (!session.is_object()) return saved;
  const auto text = [&](const char* key) {
    const auto found = session.find(key);
    return found != session.end() && found->is_string() ? found->get<std::string>() : "";
  };
  saved.record = text("record");
  saved.model = text("model");
  saved.trial = text("trial");
  saved.lineage = lineage_of(session);
  if (const auto spans = session.find("ignored"); spans != session.end() && spans->is_array()) {
    for (const ordered_json& span : *spans) {
      if (span.is_string()) saved.ignored.push_back(span.get<std::string>());
    }
  }
  return saved;
}

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
