// A line above a table of numbers that would be its first row but for a damaged field: neither
// names nor units nor a preamble.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "config/record/text_fields.h"

namespace config::record {

/// The rows below a line, as far as they were read. Refers to its arguments.
struct RowsBelow {
  char decimal = '.';
  const std::vector<FieldKind>& kinds;
  const std::vector<std::vector<double>>& head;  ///< first values of each column, clocks in s
  bool named = false;                            ///< another line above has the names
};

/// The first damaged field; none where the line is no row. A line that begins with a number is a
/// row where it is mostly numbers, stands below the names or where that number leads to the
/// column's own; any other line is one where all that are no numbers look damaged.
[[nodiscard]] std::optional<std::size_t> damaged_field(const std::vector<std::string>& fields,
                                                       const RowsBelow& rows);

}  // namespace config::record
