// Worst-case time from a failure to null at the valve, and the rod travel until then. Printed by
// `--check`; the tests compare measurements with these bounds.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "daemon/control/guard_config.h"
#include "hal/backend.h"

namespace monitor {

/// The facts that determine the table.
struct NullTableInputs {
  std::string backend;  ///< the valve's backend
  hal::NullTimes times;
  double sample_time_s = 0.005;
  double speed_mps = 0.0;  ///< fastest rod speed under a held command
  double ramp_s = 0.2;
  std::int64_t max_bad_in_a_row = 3;
  std::vector<control::GuardConfig> guards;  ///< control::all_guards
  bool has_e_stop = false;
  bool has_enable = false;
  bool has_permit = false;
  double reading_hold_s = 0.0;  ///< longest age at which a position or a switch still counts
};

struct NullRow {
  std::string failure;
  double time_s;     ///< NaN: never
  std::string note;  ///< replaces or explains the time
};

[[nodiscard]] std::vector<NullRow> null_rows(const NullTableInputs& inputs);

/// Prints the rows as TOML comments, with the rod travel for each time.
void print_null_table(const NullTableInputs& inputs, std::ostream& out);

}  // namespace monitor
