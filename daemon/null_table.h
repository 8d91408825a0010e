// How soon, at worst, the valve is at null after a failure, and how far the rod may travel until
// then: what `--check` prints, and what tests hold measurements against.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "daemon/control/guard_config.h"
#include "hal/backend.h"

namespace monitor {

/// What the table is worked out from.
struct NullTableInputs {
  std::string backend;  ///< of the valve
  hal::NullTimes times;
  double sample_time_s = 0.005;
  double speed_mps = 0.0;  ///< fastest rod under a held command
  double ramp_s = 0.2;
  std::int64_t max_bad_in_a_row = 3;
  std::vector<control::GuardConfig> guards;  ///< control::all_guards
  bool has_e_stop = false;
  bool has_enable = false;
  bool has_permit = false;
};

struct NullRow {
  std::string failure;
  double time_s;     ///< NaN: never
  std::string note;  ///< instead of a time, or besides it
};

[[nodiscard]] std::vector<NullRow> null_rows(const NullTableInputs& inputs);

/// The rows as comments of a TOML file, with the travel that goes with each time.
void print_null_table(const NullTableInputs& inputs, std::ostream& out);

}  // namespace monitor
