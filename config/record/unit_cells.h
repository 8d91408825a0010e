// Cells that carry their unit: "12.5 %", "3.2 mm", "4,5V". The unit is the column's where all of
// its cells have the same one.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "config/record/unit_text.h"

namespace config::record {

/// The allowed way to write units into cells, for messages.
inline constexpr const char* kOneUnit = "the same unit in every cell of a column, or in none";

/// A cell, parted. Refers to the cell's text.
struct UnitCell {
  std::string_view number;  ///< "3.2" of "3.2 mm"; whether it is a number is for the dialect to say
  std::string_view suffix;  ///< " mm"
  UnitText unit;            ///< known
};

/// None where `field` does not begin as a number or does not end in a known unit.
[[nodiscard]] std::optional<UnitCell> unit_cell(std::string_view field);

/// The unit of "NaN mm", "-- mm": a gap in a column whose cells carry their unit.
[[nodiscard]] std::optional<UnitText> missing_cell_unit(std::string_view field);
[[nodiscard]] bool is_missing_cell(std::string_view field);

/// "3.2" of "3.2 mm", all of any other text.
[[nodiscard]] std::string_view without_unit(std::string_view field);

[[nodiscard]] bool same_unit(const UnitText& a, const UnitText& b);

/// The unit that the cells of one column carry, and the first cell that is not like the others.
class CellUnits {
 public:
  /// `cell`: none for a number without a unit.
  void take_number(std::string_view field, const std::optional<UnitCell>& cell, std::size_t line);
  /// A word that begins as a number is a name: "1A", "1B".
  void take_word(std::string_view field, std::size_t line);

  /// A gap with a unit.
  void take_missing(const UnitText& unit);

  /// Makes the unit of the gaps that of the column where no cell has a number.
  void take_unit_of_gaps();

  /// The numbers may be a setting: the column is no matter of refusing the file.
  void doubt() { doubtful_ = true; }
  [[nodiscard]] bool doubtful() const { return doubtful_; }

  /// Whole numbers with the unit right behind: "24V", "1A".
  [[nodiscard]] bool glued() const { return glued_ && with_unit_ > 0; }

  /// The column is one of numbers with units, whole or with a cell that has to be refused.
  [[nodiscard]] bool any() const { return !names_ && with_unit_ > words_; }
  [[nodiscard]] bool words() const { return words_ > 0; }

  [[nodiscard]] const UnitText& unit() const { return unit_; }
  /// Unit of the first gap that has one.
  [[nodiscard]] const UnitText& gaps() const { return gaps_; }
  [[nodiscard]] const std::string& first() const { return first_; }
  /// Line of the first cell with a number, from 1.
  [[nodiscard]] std::size_t line() const { return line_; }
  /// Line, from 1, of a cell that is a word or has another unit; 0: none.
  [[nodiscard]] std::size_t odd_line() const { return odd_line_; }
  [[nodiscard]] const std::string& odd() const { return odd_; }

  /// The number in `field` where its unit is the column's; none where it is not.
  [[nodiscard]] std::optional<std::string_view> number_in(std::string_view field) const;

  /// "'3 cm' is in cm, the cells before are in mm"
  [[nodiscard]] std::string conflict(std::string_view field) const;

 private:
  void note_odd(std::string_view field, std::size_t line);

  bool names_ = false;
  bool glued_ = true;
  bool doubtful_ = false;
  UnitText gaps_;  ///< the unit of the first gap that has one
  std::size_t words_ = 0;
  std::size_t with_unit_ = 0;
  std::string first_;  ///< first cell with a number; empty: none so far
  std::size_t line_ = 0;
  std::string suffix_;
  UnitText unit_;  ///< the first cell's; text empty: it has none
  std::size_t odd_line_ = 0;
  std::string odd_;
};

}  // namespace config::record
