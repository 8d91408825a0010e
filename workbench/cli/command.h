// One command of the program `spoolwatch`: a name, a phrase for the help text, and a function that
// declares its options and its callback. Each command lives in its own file (listen.cpp, ...) and
// has two lines elsewhere: its declaration here and its row of the table in main.cpp.
#pragma once

namespace CLI {
class App;
}

namespace workbench::cli {

/// Declares options on `command` and sets its callback, which writes what the program shall return
/// to `exit_code` (0 when it does not). Errors that prevent a start are config::schema::Error.
using Setup = void (*)(CLI::App& command, int& exit_code);

struct Command {
  const char* name;
  const char* what;
  Setup setup;
};

void add_ack(CLI::App& command, int& exit_code);
void add_add(CLI::App& command, int& exit_code);
void add_alarms(CLI::App& command, int& exit_code);
void add_commission(CLI::App& command, int& exit_code);
void add_arm(CLI::App& command, int& exit_code);
void add_bridge(CLI::App& command, int& exit_code);
void add_backtest(CLI::App& command, int& exit_code);
void add_calibrate(CLI::App& command, int& exit_code);
void add_compare(CLI::App& command, int& exit_code);
void add_diagnose(CLI::App& command, int& exit_code);
void add_disarm(CLI::App& command, int& exit_code);
void add_effects(CLI::App& command, int& exit_code);
void add_estimate(CLI::App& command, int& exit_code);
void add_export(CLI::App& command, int& exit_code);
void add_fit(CLI::App& command, int& exit_code);
void add_hold(CLI::App& command, int& exit_code);
void add_isolate(CLI::App& command, int& exit_code);
void add_listen(CLI::App& command, int& exit_code);
void add_promote(CLI::App& command, int& exit_code);
void add_record(CLI::App& command, int& exit_code);
void add_reference(CLI::App& command, int& exit_code);
void add_reload(CLI::App& command, int& exit_code);
void add_replay(CLI::App& command, int& exit_code);
void add_reproduce(CLI::App& command, int& exit_code);
void add_reset(CLI::App& command, int& exit_code);
void add_scorecard(CLI::App& command, int& exit_code);
void add_select(CLI::App& command, int& exit_code);
void add_shelve(CLI::App& command, int& exit_code);
void add_simulate(CLI::App& command, int& exit_code);
void add_start(CLI::App& command, int& exit_code);
void add_status(CLI::App& command, int& exit_code);
void add_stop(CLI::App& command, int& exit_code);
void add_train(CLI::App& command, int& exit_code);
void add_unshelve(CLI::App& command, int& exit_code);

}  // namespace workbench::cli
