// Options and positionals that many commands share: one spelling and one help text each.
#pragma once

#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class App;
class Option;
}  // namespace CLI

namespace config::record {
struct ReadOptions;
}

namespace workbench::cli {

/// MODEL, required.
CLI::Option* add_model(CLI::App& command, std::string& file);
/// RECORD, required.
CLI::Option* add_record(CLI::App& command, std::string& file);
/// RECORD..., at least one.
CLI::Option* add_records(CLI::App& command, std::vector<std::string>& files);
/// --map, --resample, --flip and --advance, for every record of the command.
void add_reading(CLI::App& command, config::record::ReadOptions& reading);
/// --holdout RECORD, repeatable.
CLI::Option* add_holdouts(CLI::App& command, std::vector<std::string>& files);
/// --json FILE; "-" is standard output (present::write_json).
CLI::Option* add_json(CLI::App& command, std::string& file);
/// --report FILE.
CLI::Option* add_report(CLI::App& command, std::string& file);
/// --set table.key=value, repeatable.
CLI::Option* add_set(CLI::App& command, std::vector<std::string>& assignments);
/// --observer, 1/s.
CLI::Option* add_observer(CLI::App& command, double& observer_per_s);
/// --threads; 0 stands for one for each processor.
CLI::Option* add_threads(CLI::App& command, unsigned& threads);
/// --quiet.
CLI::Option* add_quiet(CLI::App& command, bool& quiet);

/// The command as it can be typed again: what was given of its positionals and options. Only once
/// `command` is parsed.
[[nodiscard]] std::string command_line(const std::string& name, const CLI::App& command);

/// Help text on Ctrl-C for commands that return what they have found so far.
void add_interrupt_footer(CLI::App& command);

}  // namespace workbench::cli
