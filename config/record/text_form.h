// The form of a text file with columns of numbers: what separates columns and decimals, where the
// numbers begin, and which lines above them name columns and units.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "config/record/text_table.h"

namespace config::record {

/// A line between names and numbers that is neither units nor a row.
struct PassedLine {
  std::size_t line = 0;  ///< from 1
  std::string text;
};

struct TextForm {
  TextDialect dialect;
  std::size_t header_line = 0;     ///< from 1; 0: no line names the columns
  std::size_t unit_line = 0;       ///< from 1; 0: none
  std::vector<std::string> names;  ///< as many as there are columns; empty without a header
  std::vector<std::string> units;  ///< likewise; empty without a line of units
  std::vector<PassedLine> passed;  ///< in the order of the file
  std::vector<std::vector<PassedLine>> factors;  ///< "'Faktor' '0.001'", by column
  std::vector<FieldKind> kinds;                  ///< one per column
  std::vector<ColumnDecimals> decimals;          ///< likewise
  std::vector<CellUnits> cell_units;             ///< likewise
  std::vector<std::vector<double>> head;         ///< first values of each column, clocks in s
  std::size_t data_offset = 0;                   ///< byte at which the first row begins
  std::size_t data_line = 0;                     ///< its line, from 1
  double step_s = 0.0;                           ///< sampling period in the lines above; 0: none
  double stated_step_s = 0.0;                    ///< likewise, by words that may mean another
};

/// Lines that find_form looks at.
inline constexpr std::ptrdiff_t kMostFormLines = 1000;

/// Throws schema::DataError for text without columns of numbers, or of which more than one reading
/// is possible. `text` has no byte order mark; its first kMostFormLines lines will do.
[[nodiscard]] TextForm find_form(std::string_view text, const std::string& name);

}  // namespace config::record
