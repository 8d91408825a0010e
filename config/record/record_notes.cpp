#include "config/record/record_notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "config/record/unit_text.h"
#include "config/units/quantity.h"

namespace config::record {

void note_units(Record& record) {
  if (record.command_unit != "V") {
    const std::string unit = unit_words(record.command_unit);
    record.notes.push_back("the command is in " + unit + ": every V of the results stands for 1 " +
                           unit);
  }
  // `_m` stands for rad in everything about an axis that turns.
  const bool as_printed =
      record.position_unit == "m" || record.position_unit == config::units::axis_unit("m");
  if (!as_printed) {
    const std::string unit = unit_words(record.position_unit);
    record.notes.push_back("the position is in " + unit + ": every " +
                           config::units::axis_unit("m") + " of the results stands for 1 " + unit);
  }
}

void note_constants(Record& record) {
  const auto is_constant = [](const std::vector<double>& values) {
    return !values.empty() && std::all_of(values.begin(), values.end(),
                                          [&](double value) { return value == values.front(); });
  };
  if (!record.has_position) return;
  if (is_constant(record.u_V)) {
    record.notes.push_back(
        fmt::format("the command is {:.6g} {} throughout: nothing can be learned of its effect",
                    record.u_V.front(), unit_words(record.command_unit)));
  }
  if (is_constant(record.y_m)) {
    record.notes.push_back(fmt::format("the position is {:.6g} {} throughout", record.y_m.front(),
                                       unit_words(record.position_unit)));
  }
}

}  // namespace config::record
