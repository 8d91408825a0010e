#include "config/record/unit_cells.h"

#include <algorithm>

#include "config/record/layout.h"
#include "config/record/text_fields.h"

namespace config::record {
namespace {

std::string unit_text_of(std::string_view suffix) {
  std::string text = clean_text(suffix);
  for (const std::string_view blank : {"\xC2\xA0", "\xE2\x80\xAF"}) {  // no-break spaces
    if (text.starts_with(blank)) text.erase(0, blank.size());
  }
  return text;
}

bool begins_as_number(std::string_view field) {
  return !field.empty() && (is_digit(field.front()) || field.starts_with(kMinusSign) ||
                            std::string_view("+-.,").find(field.front()) != std::string_view::npos);
}

/// A letter, colon or stroke within a number: a name, a time of day, a range.
bool ends_number(std::string_view field, std::size_t at) {
  const char c = field[at];
  if (is_digit(c) || static_cast<unsigned char>(c) >= 0x80) return false;
  const bool behind_exponent = at > 0 && (field[at - 1] == 'e' || field[at - 1] == 'E');
  if (c == '+' || c == '-') return at > 0 && !behind_exponent;
  return std::string_view(".,' eE").find(c) == std::string_view::npos;
}

}  // namespace

std::optional<UnitCell> unit_cell(std::string_view field) {
  constexpr std::size_t kLongest = 64;
  if (field.size() > kLongest || !begins_as_number(field)) return std::nullopt;
  for (std::size_t end = 1; end < field.size(); ++end) {
    if (ends_number(field, end - 1)) return std::nullopt;
    if (!is_digit(field[end - 1]) || is_digit(field[end])) continue;
    UnitText unit = parse_plain_unit(unit_text_of(field.substr(end)));
    if (!unit.known() || unit.si == "1") continue;
    return UnitCell{field.substr(0, end), field.substr(end), std::move(unit)};
  }
  return std::nullopt;
}

std::optional<UnitText> missing_cell_unit(std::string_view field) {
  constexpr std::size_t kLongest = 32;
  if (field.size() > kLongest || is_digit(field.empty() ? '0' : field.front())) return {};
  for (std::size_t end = 1; end < field.size(); ++end) {
    const std::string_view word = trimmed(field.substr(0, end));
    if (!is_missing(word)) continue;
    // "NAm" is a name, "NaNmm" is none.
    const std::string text = lower(word);
    const bool blank = is_blank(field[end]) || static_cast<unsigned char>(field[end]) >= 0x80;
    if (!blank && !is_blank(field[end - 1]) && !text.ends_with("nan") && !text.ends_with("--")) {
      continue;
    }
    UnitText unit = parse_plain_unit(unit_text_of(field.substr(end)));
    if (unit.known() && unit.si != "1") return unit;
  }
  return {};
}

bool is_missing_cell(std::string_view field) { return missing_cell_unit(field).has_value(); }

std::string_view without_unit(std::string_view field) {
  const std::optional<UnitCell> cell = unit_cell(field);
  return cell ? cell->number : field;
}

bool same_unit(const UnitText& a, const UnitText& b) {
  return a.si == b.si && a.factor == b.factor;
}

void CellUnits::take_number(std::string_view field, const std::optional<UnitCell>& cell,
                            std::size_t line) {
  const UnitText unit = cell ? cell->unit : UnitText{};
  with_unit_ += cell ? 1 : 0;
  glued_ = glued_ && (!cell || (std::all_of(cell->number.begin(), cell->number.end(), is_digit) &&
                                unit.text == cell->suffix));
  if (first_.empty()) {
    first_ = std::string(field);
    line_ = line;
    suffix_ = std::string(cell ? cell->suffix : std::string_view{});
    unit_ = unit;
  } else if (!same_unit(unit, unit_)) {
    note_odd(field, line);
  }
}

void CellUnits::take_word(std::string_view field, std::size_t line) {
  ++words_;
  names_ = names_ || begins_as_number(field);
  note_odd(field, line);
}

void CellUnits::take_missing(const UnitText& unit) {
  if (!gaps_.known()) gaps_ = unit;
}

void CellUnits::take_unit_of_gaps() {
  if (!gaps_.known() || !first_.empty()) return;
  unit_ = gaps_;
  suffix_ = " " + gaps_.text;
  with_unit_ = words_ + 1;
}

void CellUnits::note_odd(std::string_view field, std::size_t line) {
  if (odd_line_ > 0) return;
  odd_line_ = line;
  odd_ = std::string(field);
}

std::optional<std::string_view> CellUnits::number_in(std::string_view field) const {
  if (!unit_.known()) return field;
  if (field.size() > suffix_.size() && field.ends_with(suffix_)) {
    const std::string_view number = field.substr(0, field.size() - suffix_.size());
    if (is_digit(number.back())) return number;
  }
  const std::optional<UnitCell> cell = unit_cell(field);
  if (!cell || !same_unit(cell->unit, unit_)) return std::nullopt;
  return cell->number;
}

std::string CellUnits::conflict(std::string_view field) const {
  const std::optional<UnitCell> cell = unit_cell(field);
  if (!cell && !begins_as_number(field)) return quoted(field) + " is no number";
  return quoted(field) + (cell ? " is in " + cell->unit.text : std::string(" has no unit")) +
         ", the cells before " +
         (unit_.known() ? "are in " + unit_.text : std::string("have no unit"));
}

}  // namespace config::record
