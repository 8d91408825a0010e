#include "config/record/limit_line.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "config/record/layout.h"
#include "config/record/text_fields.h"
#include "config/record/unit_cells.h"
#include "config/record/unit_scale.h"
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
  constexpr std::array<std::string_view, 20> kWords{
      "min",   "max",     "minimum",   "maximum",     "minval", "maxval",    "low",
      "high",  "lower",   "upper",     "limit",       "limits", "lowlimit",  "highlimit",
      "range", "bereich", "fullscale", "messbereich", "mean",   "mittelwert"};
  return std::find(kWords.begin(), kWords.end(), folded(field)) != kWords.end();
}

/// The number of "50 mm/V", "x 0.1" and "5"; none where the text begins with no number.
std::optional<double> leading_number(std::string_view field, char decimal) {
  while (!field.empty() && !is_digit(field.front()) && field.front() != '-') {
    const bool mark = field.front() == 'x' || field.front() == '*' || field.front() == '+' ||
                      is_blank(field.front()) || static_cast<unsigned char>(field.front()) >= 0x80;
    if (!mark) return std::nullopt;
    field.remove_prefix(1);
  }
  double value = 0.0;
  const std::string_view number = without_unit(field.substr(0, field.find(' ')));
  if (!parse_number(number, decimal, value)) return std::nullopt;
  return value;
}

/// ";x 1;x 0.1", factors without a word in front.
bool are_marked_numbers(const std::vector<std::string>& fields) {
  std::size_t marked = 0;
  for (const std::string& field : fields) {
    if (is_missing(field)) continue;
    if (is_digit(field.front()) || !name_has_scale(field)) return false;
    ++marked;
  }
  return marked > 0;
}

bool has_any(const std::string& word, const auto& parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](std::string_view part) { return word.find(part) != std::string::npos; });
}

/// "Offset", "Nullpunkt": a number that is added.
bool is_offset_word(std::string_view field) {
  constexpr std::array<std::string_view, 4> kParts{"offset", "nullpunkt", "zeropoint", "intercept"};
  return has_any(folded(field), kParts) && folded(field).find("vertical") == std::string::npos;
}

/// "Factor", "Scale", "Gain [mm/V]": a number that multiplies. An oscilloscope's vertical scale is
/// that of its screen, a controller's gain a setting.
bool is_factor_word(std::string_view field) {
  constexpr std::array<std::string_view, 12> kParts{
      "factor", "faktor",      "facteur",         "gain", "scal", "skal", "multipli", "sensitiv",
      "slope",  "empfindlich", "verst\xC3\xA4rk", "ratio"};
  constexpr std::array<std::string_view, 6> kOthers{"vertical", "horizontal", "vscale",
                                                    "hscale",   "controller", "regler"};
  const std::string word = folded(field);
  return !is_limit_word(field) && has_any(word, kParts) && !has_any(word, kOthers);
}

}  // namespace

bool is_limit_line(const std::vector<std::string>& fields, char decimal) {
  bool word = false;
  std::size_t ranges = 0;
  std::size_t numbers = 0;
  bool factors = false;
  for (const std::string& field : fields) {
    if (is_missing(field)) continue;
    if (is_range(field, decimal)) {
      ++ranges;
    } else if (is_bound(field, decimal) || (factors && leading_number(field, decimal))) {
      ++numbers;
    } else if (!word && ranges == 0 && numbers == 0 &&
               (is_limit_word(field) || is_factor_word(field) || is_offset_word(field))) {
      word = true;
      factors = !is_limit_word(field);
    } else {
      return false;
    }
  }
  if (word || ranges == 0) return word && ranges + numbers > 0;
  // "0;1;0..35" is a row with a damaged field
  return ranges > numbers || !is_bound(fields.front(), decimal);
}

std::vector<std::string> stated_factors(const std::vector<std::string>& fields, char decimal) {
  std::size_t first = 0;
  while (first < fields.size() && is_missing(fields[first])) ++first;
  if (first == fields.size()) return {};
  const bool marked = are_marked_numbers(fields);
  const std::string word = marked ? "" : clean_text(fields[first]);
  const bool offset = is_offset_word(word);
  if (!marked && !offset && !is_factor_word(word)) return {};
  std::vector<std::string> factors(fields.size());
  for (std::size_t c = marked ? first : first + 1; c < fields.size(); ++c) {
    const std::optional<double> value = leading_number(trimmed(fields[c]), decimal);
    if (!value || *value == (offset ? 0.0 : 1.0)) continue;
    factors[c] = (marked ? "" : record::quoted(word) + " ") + record::quoted(fields[c]);
  }
  return factors;
}

}  // namespace config::record
