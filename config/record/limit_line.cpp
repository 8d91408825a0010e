#include "config/record/limit_line.h"

#include <algorithm>
#include <array>
#include <cctype>
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

/// "V/V" of "1 V/V", "/1" of "1/1", or nothing.
bool is_ratio_of_one(std::string_view unit) {
  const bool brackets = unit.size() > 2 && ((unit.front() == '[' && unit.back() == ']') ||
                                            (unit.front() == '(' && unit.back() == ')'));
  if (brackets) unit = trimmed(unit.substr(1, unit.size() - 2));
  if (unit.empty() || unit == "-" || unit == "/1" || unit == ":1") return true;
  const std::size_t stroke = unit.find('/');
  if (stroke == std::string_view::npos || stroke == 0) return false;
  return trimmed(unit.substr(0, stroke)) == trimmed(unit.substr(stroke + 1));
}

/// "1", "x 1", "1.0" and "1 V/V"; of offsets "0" and "0 mm".
bool changes_nothing(std::string_view field, bool offset, char decimal) {
  for (const std::string_view mark : {"x", "*", "+", "\xC3\x97", "\xC2\xB7"}) {
    if (field.starts_with(mark)) field = trimmed(field.substr(mark.size()));
  }
  const std::size_t end = std::min(field.find_first_not_of("0123456789.,-+eE"), field.size());
  const std::string_view number = field.substr(0, end);
  const std::string_view unit = trimmed(field.substr(end));
  // "1.000" beside decimal commas may be a thousand, "1.0" is none.
  constexpr std::size_t kThousand = 5;
  double value = 0.0;
  const bool read = parse_number(number, decimal, value) ||
                    ((offset || number.size() != kThousand) &&
                     parse_number(number, decimal == '.' ? ',' : '.', value));
  if (!read || value != (offset ? 0.0 : 1.0)) return false;
  return offset ? std::none_of(unit.begin(), unit.end(), is_digit) : is_ratio_of_one(unit);
}

/// True for all that stands for a number or a fraction: "1/100", "10^-3", "div 10", "Zehntel". The
/// digits of a name are none: "AI1", "log10".
bool states_number(std::string_view field) {
  if (name_has_scale(field)) return true;
  char before = ' ';
  bool name = false;
  for (const char c : field) {
    const auto letter = [](char one) { return std::isalpha(static_cast<unsigned char>(one)) != 0; };
    const bool inside = letter(before) || is_digit(before) || before == '_' || before == '.';
    if (!inside) name = letter(c) && c != 'x';
    if (is_digit(c) && !name) return true;
    before = c;
  }
  return false;
}

/// "1/100", "x 0.1", ".001": no name, no unit.
bool begins_as_factor(std::string_view field) {
  const std::size_t digit = field.find_first_of("0123456789");
  return digit != std::string_view::npos &&
         std::all_of(field.begin(), field.begin() + static_cast<std::ptrdiff_t>(digit), [](char c) {
           const auto byte = static_cast<unsigned char>(c);
           return c == 'x' || byte >= 0x80 || std::isalpha(byte) == 0;
         });
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
  const std::string word = folded(field);
  return word == "zero" || word == "bias" ||
         (has_any(word, kParts) && word.find("vertical") == std::string::npos);
}

/// "Factor", "Scale", "Gain [mm/V]": a number that multiplies. An oscilloscope's vertical scale is
/// that of its screen, a controller's gain a setting.
bool is_factor_word(std::string_view field) {
  constexpr std::array<std::string_view, 13> kParts{"factor",
                                                    "faktor",
                                                    "facteur",
                                                    "gain",
                                                    "scal",
                                                    "skal",
                                                    "multipli",
                                                    "sensitiv",
                                                    "slope",
                                                    "empfindlich",
                                                    "verst\xC3\xA4rkung",
                                                    "conversion",
                                                    "umrechnung"};
  constexpr std::array<std::string_view, 9> kOthers{"vertical", "horizontal",     "vscale",
                                                    "hscale",   "controller",     "regler",
                                                    "against",  "conversionrate", "conversiontime"};
  const std::string word = folded(field);
  if (is_limit_word(field) || has_any(word, kOthers)) return false;
  // "duration" and "calibration" are no ratios
  const bool ratio =
      word.find("ratio") != std::string::npos && word.find("ration") == std::string::npos;
  return ratio || word == "sign" || word == "vorzeichen" || word == "lsb" || has_any(word, kParts);
}

/// True for a number beside a word of factors or offsets that changes a value.
bool changes_value(std::string_view field, bool offset, char decimal) {
  field = trimmed(field);
  return !is_missing(field) && states_number(field) && !changes_nothing(field, offset, decimal);
}

/// True where a field is a word of factors or offsets and a number behind it changes a value.
bool has_factor(const std::vector<std::string>& fields, char decimal) {
  for (std::size_t word = 0; word + 1 < fields.size(); ++word) {
    const bool offset = is_offset_word(fields[word]);
    if (!offset && !is_factor_word(fields[word])) continue;
    for (std::size_t c = word + 1; c < fields.size(); ++c) {
      if (changes_value(fields[c], offset, decimal)) return true;
    }
  }
  return false;
}

/// "Faktor Weg" and "0.1 mm" of "Faktor Weg 0.1 mm"; empty where more is said.
std::vector<std::string> word_and_number(std::string_view line) {
  constexpr std::ptrdiff_t kMostBlanks = 3;  // more are those of a sentence
  for (std::size_t at = line.find(' '); at != std::string_view::npos; at = line.find(' ', at + 1)) {
    const std::string_view number = trimmed(line.substr(at));
    if (!begins_as_factor(number)) continue;
    const std::string_view word = line.substr(0, at);
    if (std::count(word.begin(), word.end(), ' ') > kMostBlanks) return {};
    if (std::count(number.begin(), number.end(), ' ') > 1) return {};
    return {std::string(word), std::string(number)};
  }
  return {};
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
    } else if (is_bound(field, decimal) || (factors && begins_as_factor(field))) {
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
    if (!changes_value(fields[c], offset, decimal)) continue;
    factors[c] = (marked ? "" : record::quoted(word) + " ") + record::quoted(fields[c]);
  }
  return factors;
}

bool states_factor(std::string_view line, char separator, char decimal) {
  for (const char each : {separator, ':', '='}) {
    if (has_factor(split_fields(line, each), decimal)) return true;
  }
  return has_factor(word_and_number(line), decimal);
}

}  // namespace config::record
