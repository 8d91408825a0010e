#include "workbench/cli/file_places.h"

#include <CLI/CLI.hpp>

#include "config/schema/error.h"
#include "workbench/files/file_kind.h"

namespace workbench::cli {
namespace {

using config::schema::UsageError;
using files::FileKind;

/// A file that is not what its place asks for.
struct Misplaced {
  std::string place;  ///< "MODEL"
  std::string file;
};

FileKind wanted_at(const std::string& place) {
  if (place == "RECORD" || place == "--holdout") return FileKind::record;
  const bool toml =
      place == "MODEL" || place == "model" || place == "config" || place == "configuration";
  return toml ? FileKind::toml : FileKind::other;
}

/// "spoolwatch compare MODEL RECORD"
std::string order_of(const CLI::App& command) {
  std::string order = "spoolwatch " + command.get_name();
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) order += " " + option->get_name(true);
  }
  return order;
}

}  // namespace

void check_places(const CLI::App& command) {
  std::vector<Misplaced> records, others;
  for (const CLI::Option* option : command.get_options()) {
    const std::string place = option->get_name(option->get_positional());
    const FileKind wanted = wanted_at(place);
    if (wanted == FileKind::other) continue;
    for (const std::string& file : option->results()) {
      const FileKind kind = files::kind_of(file);
      if (kind == FileKind::other || kind == wanted) continue;
      (kind == FileKind::record ? records : others).push_back({place, file});
    }
  }
  if (records.empty() && others.empty()) return;
  std::string objection = command.get_name() + ": ";
  if (!records.empty() && !others.empty()) {
    objection += records.front().place + " and " + others.front().place + " are swapped: ";
  }
  if (!records.empty()) objection += records.front().file + " is a record";
  if (!records.empty() && !others.empty()) objection += ", ";
  if (!others.empty()) objection += others.front().file + " is a TOML file";
  if (others.empty()) objection += ", but " + records.front().place + " must be a TOML file";
  if (records.empty()) objection += ", but " + others.front().place + " must be a record";
  throw UsageError(objection + "; the order is: " + order_of(command));
}

}  // namespace workbench::cli
