#include "config/record/text_fields.h"

#include <array>
#include <cctype>
#include <charconv>
#include <limits>

namespace config::record {

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
  const std::string word = lower(field);
  for (const std::string_view missing :
       {"nan",  "-nan", "+nan", "nan(ind)", "-nan(ind)", "na",      "n/a",
        "#n/a", "#na",  "#nv",  "null",     "none",      "nil",     "-",
        "--",   "---",  "?",    "novalue",  "-1.#ind",   "#value!", "#div/0!"}) {
    if (word == missing) return true;
  }
  return false;
}

bool parse_number(std::string_view field, char decimal, double& value) {
  if (field.starts_with('+')) field.remove_prefix(1);
  if (field.empty() || !(is_digit(field.front()) || field.front() == '-' || field.front() == '.' ||
                         field.front() == ',')) {
    return false;
  }
  std::array<char, 64> buffer{};
  if (decimal == ',') {
    if (field.size() >= buffer.size()) return false;
    const std::size_t comma = field.find(',');
    // A point is no decimal sign here; before a comma it may group thousands: 1.234,5.
    if (comma == std::string_view::npos && field.find('.') != std::string_view::npos) return false;
    std::size_t size = 0;
    std::size_t group = 0;
    bool grouped = false;
    for (std::size_t i = 0; i < field.size(); ++i) {
      const char c = field[i];
      if (c == '.') {
        const bool in_place =
            i < comma && i > 0 && is_digit(field[i - 1]) && group <= 3 && (!grouped || group == 3);
        if (!in_place) return false;
        grouped = true;
        group = 0;
        continue;
      }
      if (i < comma && is_digit(c)) ++group;
      if (i == comma && grouped && group != 3) return false;
      if (i == comma && (i + 1 == field.size() || !is_digit(field[i + 1]))) return false;
      buffer[size++] = c == ',' ? '.' : c;
    }
    field = {buffer.data(), size};
  }
  const char* const end = field.data() + field.size();
  const auto result = std::from_chars(field.data(), end, value);
  if (result.ec == std::errc::result_out_of_range && result.ptr == end) {
    value = std::numeric_limits<double>::infinity();
    return true;
  }
  return result.ec == std::errc{} && result.ptr == end;
}

}  // namespace config::record
