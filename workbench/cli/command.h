// One command of the program `spoolwatch`. A new command is a file NAME.cpp that defines add_NAME,
// and a line of commands.def, from which declarations and the table in main.cpp are made.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace workbench::cli {

/// Declares options on `command` and sets its callback, which writes the program's exit code to
/// `exit_code` unless it is 0. Errors that prevent a start are config::schema::Error.
using Setup = void (*)(CLI::App& command, int& exit_code);

#define COMMAND(group, name, what) void add_##name(CLI::App& command, int& exit_code);
#include "workbench/cli/commands.def"
#undef COMMAND

/// Markdown: every key of the files that `spoolwatch` reads, for scripts/reference.
[[nodiscard]] std::string configuration_reference();

}  // namespace workbench::cli
