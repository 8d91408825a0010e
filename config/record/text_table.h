// Where the table of numbers lies among the first lines of a text, and what separates its columns
// and decimals.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "config/record/column_decimals.h"
#include "config/record/text_fields.h"
#include "config/record/unit_cells.h"

namespace config::record {

/// One way in which a text may separate its columns and decimals.
struct TextDialect {
  char separator = ',';  ///< ' ': any number of blanks and tabs
  char decimal = '.';    ///< '.' or ','
};

/// "semicolons"
[[nodiscard]] const char* separator_words(const TextDialect& dialect);
/// "decimal commas"
[[nodiscard]] const char* decimal_words(const TextDialect& dialect);

/// The kind of a field without blanks around, and its number or time in s; NaN: none.
[[nodiscard]] FieldKind kind_of(std::string_view field, char decimal, double& value);
/// The same, a number with a unit behind it being one too.
[[nodiscard]] FieldKind cell_kind(std::string_view field, char decimal, double& value);

struct TextLine {
  std::string_view text;  ///< without its end
  std::size_t offset = 0;
};

/// Rows in one dialect, the longest run of them that the lines have.
struct TextTable {
  TextDialect dialect;
  std::size_t first = 0;  ///< line of the first row, from 0
  std::size_t rows = 0;   ///< consecutive rows among the lines looked at
  std::size_t columns = 0;
  std::vector<FieldKind> kinds;
  std::vector<std::vector<double>> head;  ///< first values of each column
  std::vector<ColumnDecimals> decimals;   ///< one per column
  std::vector<CellUnits> cell_units;      ///< likewise; of a column of numbers
};

/// Throws schema::DataError where there is none, or where the lines can be read in two ways.
[[nodiscard]] TextTable find_table(const std::vector<TextLine>& lines, const std::string& name);

}  // namespace config::record
