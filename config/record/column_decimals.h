// Which decimal sign the numbers of one column have, where commas may stand for either: "1,234.5",
// "1,25" and "1,234" in quotes.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "config/record/text_fields.h"

namespace config::record {

/// Rows of which the first values are kept.
inline constexpr std::size_t kHeadRows = 60;

/// The spellings allowed where a number has two readings.
inline constexpr const char* kOneReading =
    "numbers without separators of thousands, or one decimal sign in all of a column's numbers";

/// How the numbers of one column are written.
struct ColumnDecimals {
  char decimal = '.';
  LoneGroup lone = LoneGroup::refused;
  std::string ambiguous;  ///< a field that has two readings, and none of the column says which
};

/// The decimals of a column, field by field.
class ColumnReading {
 public:
  /// False: the field contradicts those before it.
  [[nodiscard]] bool allows(const std::string& field, FieldKind kind) const;

  void take(const std::string& field, FieldKind kind);

  [[nodiscard]] bool shows_comma() const { return shows_comma_; }
  [[nodiscard]] bool shows_thousands() const { return shows_point_ && !either_.empty(); }

  /// others: how the undecided columns of the file are read, by those that decide.
  [[nodiscard]] ColumnDecimals decimals(char others) const;

  [[nodiscard]] std::vector<double> head(char decimal) const;

 private:
  bool shows_point_ = false, shows_comma_ = false;
  std::string either_;  ///< the first field with both readings
  std::vector<std::pair<double, double>> head_;
};

}  // namespace config::record
