#include "config/record/text_fields.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <limits>

namespace config::record {

namespace {

/// With "-" for that sign, at the front and in the exponent.
std::string with_plain_minus(std::string_view field) {
  std::string plain;
  while (!field.empty()) {
    const bool sign = plain.empty() || plain.back() == 'e' || plain.back() == 'E';
    const bool minus = sign && field.starts_with(kMinusSign);
    plain += minus ? '-' : field.front();
    field.remove_prefix(minus ? kMinusSign.size() : 1);
  }
  return plain;
}

}  // namespace

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::vector<std::string> split_fields(std::string_view line, char separator) {
  std::vector<std::string> fields;
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (separator == ' ') line = trimmed(line);
  std::size_t at = 0;
  while (true) {
    while (at < line.size() && line[at] != separator && is_blank(line[at])) ++at;
    std::string field;
    if (at < line.size() && line[at] == '"') {
      ++at;
      while (at < line.size()) {
        if (line[at] == '"' && at + 1 < line.size() && line[at + 1] == '"') {
          field += '"';
          at += 2;
        } else if (line[at] == '"') {
          ++at;
          break;
        } else {
          field += line[at++];
        }
      }
      field = std::string(trimmed(field));
    }
    const std::size_t begin = at;
    while (at < line.size() && line[at] != separator && !(separator == ' ' && is_blank(line[at]))) {
      ++at;
    }
    field += trimmed(line.substr(begin, at - begin));
    fields.push_back(std::move(field));
    if (at >= line.size()) return fields;
    ++at;
    if (separator == ' ') {
      while (at < line.size() && is_blank(line[at])) ++at;
    }
  }
}

bool is_missing(std::string_view field) {
  if (field.empty()) return true;
  if (field.size() > 9 || is_digit(field.front())) return field == "1.#QNAN" || field == "1.#IND";
  // A lone minus sign or dash, as word processors write it.
  if (field == kMinusSign || field == "\xE2\x80\x93" || field == "\xE2\x80\x94") return true;
  const std::string word = lower(field);
  for (const std::string_view missing :
       {"nan",  "-nan", "+nan", "nan(ind)", "-nan(ind)", "na",      "n/a",
        "#n/a", "#na",  "#nv",  "null",     "none",      "nil",     "-",
        "--",   "---",  "?",    "novalue",  "-1.#ind",   "#value!", "#div/0!"}) {
    if (word == missing) return true;
  }
  return false;
}

namespace {

/// Bytes of a separator of thousands at the front of `text`, other than the point and the comma; 0:
/// none. Blank, no-break spaces (UTF-8 and Latin-1) and apostrophes.
std::size_t group_blank(std::string_view text) {
  using namespace std::string_view_literals;
  for (const std::string_view mark :
       {" "sv, "'"sv, "\xC2\xA0"sv, "\xE2\x80\xAF"sv, "\xE2\x80\x99"sv, "\xA0"sv}) {
    if (text.starts_with(mark)) return mark.size();
  }
  return 0;
}

/// Writes "1234.5" for "1,234.5" to `out`. False: no number with groups of thousands.
bool ungroup(std::string_view field, char decimal, LoneGroup lone, std::array<char, 64>& out,
             std::size_t& size) {
  if (field.size() >= out.size()) return false;
  const char other = decimal == '.' ? ',' : '.';
  size = 0;
  const auto copy_digits = [&] {
    std::size_t count = 0;
    for (; !field.empty() && is_digit(field.front()); ++count) {
      out[size++] = field.front();
      field.remove_prefix(1);
    }
    return count;
  };
  if (field.starts_with('-')) {
    out[size++] = '-';
    field.remove_prefix(1);
  }
  if (field.starts_with('0')) return false;
  const std::size_t first = copy_digits();
  if (first == 0 || first > 3 || field.empty()) return false;
  const bool by_sign = field.front() == other;
  const std::string_view mark = field.substr(0, by_sign ? 1 : group_blank(field));
  if (mark.empty()) return false;
  const std::string separator(mark);
  std::size_t groups = 0;
  while (field.starts_with(separator)) {
    field.remove_prefix(separator.size());
    if (copy_digits() != 3) return false;
    ++groups;
  }
  const bool fraction = field.starts_with(decimal);
  if (fraction) {
    field.remove_prefix(1);
    out[size++] = '.';
    if (copy_digits() == 0) return false;
  }
  return field.empty() && (!by_sign || fraction || groups > 1 || lone == LoneGroup::thousands);
}

}  // namespace

bool parse_number(std::string_view field, char decimal, double& value, LoneGroup lone) {
  if (field.find(kMinusSign) != std::string_view::npos) {
    const std::string plain = with_plain_minus(field);
    return plain.size() < field.size() && parse_number(plain, decimal, value, lone);
  }
  if (field.starts_with('+')) {
    field.remove_prefix(1);
    if (field.starts_with('-')) return false;
  }
  if (field.empty() || !(is_digit(field.front()) || field.front() == '-' || field.front() == '.' ||
                         field.front() == ',')) {
    return false;
  }
  std::array<char, 64> buffer{};
  std::size_t size = 0;
  const auto whole_number = [&value](std::string_view text) {
    const char* const end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec == std::errc::result_out_of_range && result.ptr == end) {
      value = std::numeric_limits<double>::infinity();
      return true;
    }
    return result.ec == std::errc{} && result.ptr == end;
  };
  const std::size_t comma = decimal == ',' ? field.find(',') : std::string_view::npos;
  if (decimal == '.') {
    if (whole_number(field)) return true;
  } else if (field.size() < buffer.size() && field.find('.') == std::string_view::npos) {
    const bool digit_follows = comma + 1 < field.size() && is_digit(field[comma + 1]);
    if (comma != std::string_view::npos && !digit_follows) return false;
    std::copy(field.begin(), field.end(), buffer.begin());
    if (comma != std::string_view::npos) buffer[comma] = '.';
    if (whole_number({buffer.data(), field.size()})) return true;
  }
  return ungroup(field, decimal, lone, buffer, size) && whole_number({buffer.data(), size});
}

}  // namespace config::record
