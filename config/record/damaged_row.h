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
/// row where it is mostly numbers, where that number leads to the column's own, or below the names
/// where all but one field are numbers or the first is a few steps before the column's own; any
/// other line with a number is one where all that are none look damaged.
[[nodiscard]] std::optional<std::size_t> damaged_field(const std::vector<std::string>& fields,
                                                       const RowsBelow& rows);

/// True where a line begins with a number that is an even step before those below: a row, whatever
/// stands in it.
[[nodiscard]] bool leads_to_rows(const std::vector<std::string>& fields, const RowsBelow& rows);

/// True where two lines, one after the other, are earlier rows of the same table: a line between
/// them and the rows below is one as well, whatever stands in it.
[[nodiscard]] bool are_rows(const std::vector<std::string>& upper,
                            const std::vector<std::string>& lower, const RowsBelow& rows);

}  // namespace config::record
