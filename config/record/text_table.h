// Where the table of numbers lies among the first lines of a text, and what separates its columns
// and decimals.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "config/record/text_fields.h"

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

enum class FieldKind { number, missing, clock, text };

/// The kind of a field without blanks around, and its number or time in s; NaN: none.
[[nodiscard]] FieldKind kind_of(std::string_view field, char decimal, double& value);

struct TextLine {
  std::string_view text;  ///< without its end
  std::size_t offset = 0;
};

/// The spellings allowed where a number has two readings.
inline constexpr const char* kOneReading =
    "numbers without separators of thousands, or one decimal sign in all of a column's numbers";

/// How the numbers of one column are written.
struct ColumnDecimals {
  char decimal = '.';
  LoneGroup lone = LoneGroup::refused;
  std::string ambiguous;  ///< a field that has two readings, and none of the column says which
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
};

/// Throws schema::DataError where there is none, or where the lines can be read in two ways.
[[nodiscard]] TextTable find_table(const std::vector<TextLine>& lines, const std::string& name);

}  // namespace config::record
