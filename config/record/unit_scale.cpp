#include "config/record/unit_scale.h"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "config/record/text_fields.h"

namespace config::record {
namespace {

constexpr std::array<std::string_view, 3> kTimes{"*", "\xC3\x97", "\xC2\xB7"};  // "×", "·"

/// The number at the front of `text`, which is cut off; false: none. `whole`: no decimals.
bool take_number(std::string_view& text, double& value, bool& whole) {
  std::string plain;
  std::size_t end = 0;
  while (end < text.size() && (is_digit(text[end]) || text[end] == '.' || text[end] == ',')) ++end;
  plain = text.substr(0, end);
  whole = plain.find_first_of(".,") == std::string::npos;
  if (const std::size_t comma = plain.find(','); comma != std::string::npos) plain[comma] = '.';
  const bool power = plain == "10" && text.substr(end).starts_with("^");
  const bool exponent = end + 1 < text.size() && (text[end] == 'e' || text[end] == 'E') &&
                        (is_digit(text[end + 1]) || text[end + 1] == '-');
  if (power || exponent) {
    std::size_t last = end + 1;
    if (last < text.size() && text[last] == '-') ++last;
    while (last < text.size() && is_digit(text[last])) ++last;
    const std::string_view digits = text.substr(end + 1, last - end - 1);
    plain = (power ? "1" : plain) + "e" + std::string(digits);
    end = last;
    whole = false;
  }
  const auto result = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  if (plain.empty() || result.ec != std::errc{} || result.ptr != plain.data() + plain.size()) {
    return false;
  }
  text.remove_prefix(end);
  return true;
}

bool is_power_of_ten(double value) {
  constexpr double kRounding = 1e-9;
  const double exponent = std::log10(value);
  return std::abs(exponent - std::round(exponent)) < kRounding;
}

/// Takes a sign of multiplication off the front or the end.
bool take_times(std::string_view& text, bool front) {
  for (const std::string_view mark : kTimes) {
    if (front ? !text.starts_with(mark) : !text.ends_with(mark)) continue;
    front ? text.remove_prefix(mark.size()) : text.remove_suffix(mark.size());
    return true;
  }
  return false;
}

/// A number with its mark in front: "*10", "x 0.1", "/ 10"; "x1" and "/1" are names.
bool is_marked(std::string_view text, bool behind_word) {
  text = trimmed(text);
  const std::string_view all = text;
  const bool times = take_times(text, true);
  const bool cross = !times && text.starts_with('x');
  const bool over = !times && text.starts_with('/');
  if (cross || over) text.remove_prefix(1);
  const bool blank = !text.empty() && is_blank(text.front());
  text = trimmed(text);
  double value = 0.0;
  bool whole = false;
  if (!take_number(text, value, whole) || !trimmed(text).empty() || !(value > 0.0)) return false;
  const bool scale = !whole || (value > 1.0 && is_power_of_ten(value));
  if (times || all.find('^') != std::string_view::npos) return true;
  if (cross) return !behind_word && (blank || scale);
  return over && scale;
}

}  // namespace

UnitScale unit_scale(std::string_view text) {
  UnitScale scale;
  double value = 0.0;
  bool whole = false;
  if (!take_number(text, value, whole)) return {};
  if (whole && text.starts_with('/')) {
    text.remove_prefix(1);
    double parts = 0.0;
    if (value != 1.0 || !take_number(text, parts, whole) || !whole || parts < 2.0) return {};
    value = 1.0 / parts;
  } else if (!(value > 0.0) || !(value < 1.0) || !is_power_of_ten(value)) {
    return {};
  }
  text = trimmed(text);
  (void)take_times(text, true);
  scale.factor = value;
  scale.unit = trimmed(text);
  return scale;
}

std::string with_plain_exponents(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 11> kRaised{{{"\xE2\x81\xBB", '-'},
                                                                       {"\xE2\x81\xB0", '0'},
                                                                       {"\xC2\xB9", '1'},
                                                                       {"\xC2\xB2", '2'},
                                                                       {"\xC2\xB3", '3'},
                                                                       {"\xE2\x81\xB4", '4'},
                                                                       {"\xE2\x81\xB5", '5'},
                                                                       {"\xE2\x81\xB6", '6'},
                                                                       {"\xE2\x81\xB7", '7'},
                                                                       {"\xE2\x81\xB8", '8'},
                                                                       {"\xE2\x81\xB9", '9'}}};
  std::string plain;
  bool raised = false;
  while (!text.empty()) {
    bool found = false;
    for (const auto& [mark, c] : kRaised) {
      if (!text.starts_with(mark)) continue;
      if (!raised) plain += '^';
      plain += c;
      text.remove_prefix(mark.size());
      found = true;
      break;
    }
    raised = found;
    if (found) continue;
    plain += text.front();
    text.remove_prefix(1);
  }
  return plain;
}

bool has_open_scale(std::string_view unit, bool (*is_unit)(std::string_view)) {
  unit = trimmed(unit);
  if (unit.size() > kMostUnitBytes) return false;
  for (std::size_t end = unit.size(); end-- > 1;) {
    if (is_unit(trimmed(unit.substr(0, end))) && is_marked(unit.substr(end), false)) return true;
  }
  std::string_view rest = unit;
  if (!take_times(rest, true) && rest.starts_with('x')) rest.remove_prefix(1);
  rest = trimmed(rest);
  double value = 0.0;
  bool whole = false;
  if (!take_number(rest, value, whole)) return false;
  rest = trimmed(rest);
  if (!take_times(rest, true) && rest.starts_with("x ")) rest.remove_prefix(1);
  return is_unit(trimmed(rest));
}

namespace {

/// "Weg in Zehntel", "Position (factor 10)".
bool has_scale_in_words(std::string_view name) {
  constexpr std::array<std::string_view, 8> kParts{
      "zehntel",   "hundertstel", "tausendstel",    "tenth",
      "hundredth", "thousandth",  "dixi\xC3\xA8me", "centi\xC3\xA8me"};
  constexpr std::array<std::string_view, 6> kFactors{"factor",  "faktor",     "facteur",
                                                     "scaled ", "multiplied", "scale "};
  const std::string text = lower(name);
  for (const std::string_view part : kParts) {
    if (text.find(part) != std::string::npos) return true;
  }
  for (const std::string_view word : kFactors) {
    const std::size_t at = text.find(word);
    if (at != std::string::npos && text.find_first_of("0123456789", at) != std::string::npos) {
      return true;
    }
  }
  return false;
}

/// "Position (1:10)"
bool has_ratio(std::string_view name) {
  const std::size_t open = name.find_last_of("([");
  if (open == std::string_view::npos || !(name.ends_with(')') || name.ends_with(']'))) return false;
  std::string_view ratio = trimmed(name.substr(open + 1, name.size() - open - 2));
  double value = 0.0;
  bool whole = false;
  if (!take_number(ratio, value, whole) || !trimmed(ratio).starts_with(':')) return false;
  ratio = trimmed(trimmed(ratio).substr(1));
  return take_number(ratio, value, whole) && ratio.empty();
}

}  // namespace

bool name_has_scale(std::string_view name) {
  name = trimmed(name);
  if (has_scale_in_words(name)) return true;
  double value = 0.0;
  bool whole = false;
  std::string_view rest = name;
  if (take_number(rest, value, whole)) {
    const bool blank = rest.starts_with(' ');
    rest = trimmed(rest);
    if (take_times(rest, true) || rest.starts_with("x ")) return true;
    const bool scale = !whole || (value > 1.0 && is_power_of_ten(value));  // "10xPosition"
    if (scale && !blank && rest.size() > 1 && rest.starts_with('x') && !is_digit(rest[1])) {
      return true;
    }
  }
  if (has_ratio(name)) return true;
  while (name.ends_with(')') || name.ends_with(']')) name.remove_suffix(1);
  const std::size_t digits = name.find_last_not_of("0123456789.,eE^- ");
  if (digits == std::string_view::npos || digits + 1 >= name.size()) return false;
  if (name.find('^', digits) != std::string_view::npos)
    return is_marked("*" + std::string(name.substr(digits + 1)), false);
  // The mark is the last character that is no part of the number, of one byte or two.
  std::size_t begin = digits;
  while (begin > 0 && (static_cast<unsigned char>(name[begin]) & 0xC0U) == 0x80U) --begin;
  const bool behind_word = begin > 0 && !is_blank(name[begin - 1]) && name[begin - 1] != '(' &&
                           name[begin - 1] != ']' && name[begin - 1] != ')';
  return is_marked(name.substr(begin), behind_word);
}

}  // namespace config::record
