#include "config/record/limit_line.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "config/record/text_fields.h"
#include "config/record/unit_cells.h"
#include "config/record/unit_text.h"

namespace config::record {
namespace {

bool is_bound(std::string_view text, char decimal) {
  double value = 0.0;
  return parse_number(without_unit(trimmed(text)), decimal, value);
}

/// "-10..10", "[-10 ... 10]", "0 to 5", "+/-10", "[-10, 10]".
bool is_range(std::string_view field, char decimal) {
  const bool brackets = field.size() > 2 && (field.front() == '[' || field.front() == '(') &&
                        (field.back() == ']' || field.back() == ')');
  if (brackets) field = trimmed(field.substr(1, field.size() - 2));
  for (const std::string_view sign : {"\xC2\xB1", "+/-", "+-"}) {
    if (field.starts_with(sign)) return is_bound(field.substr(sign.size()), decimal);
  }
  const auto parted = [&](std::string_view between) {
    const std::size_t at = field.find(between);
    return at != std::string_view::npos && is_bound(field.substr(0, at), decimal) &&
           is_bound(field.substr(at + between.size()), decimal);
  };
  constexpr std::array<std::string_view, 6> kBetween{"...",  "..",    "\xE2\x80\xA6",
                                                     " to ", " bis ", " - "};
  constexpr std::array<std::string_view, 4> kInBrackets{",", ";", ":", " "};
  return std::any_of(kBetween.begin(), kBetween.end(), parted) ||
         (brackets && std::any_of(kInBrackets.begin(), kInBrackets.end(), parted));
}

bool is_limit_word(std::string_view field) {
  constexpr std::array<std::string_view, 27> kWords{
      "min",   "max",     "minimum", "maximum", "minval",      "maxval",    "low",
      "high",  "lower",   "upper",   "limit",   "limits",      "lowlimit",  "highlimit",
      "range", "scale",   "gain",    "factor",  "offset",      "fullscale", "sensitivity",
      "mean",  "bereich", "faktor",  "skala",   "messbereich", "mittelwert"};
  return std::find(kWords.begin(), kWords.end(), folded(field)) != kWords.end();
}

}  // namespace

bool is_limit_line(const std::vector<std::string>& fields, char decimal) {
  bool word = false;
  std::size_t ranges = 0;
  std::size_t numbers = 0;
  for (const std::string& field : fields) {
    if (is_missing(field)) continue;
    if (is_range(field, decimal)) {
      ++ranges;
    } else if (is_bound(field, decimal)) {
      ++numbers;
    } else if (!word && ranges == 0 && numbers == 0 && is_limit_word(field)) {
      word = true;
    } else {
      return false;
    }
  }
  if (word || ranges == 0) return word && ranges + numbers > 0;
  // "0;1;0..35" is a row with a damaged field
  return ranges > numbers || !is_bound(fields.front(), decimal);
}

}  // namespace config::record
