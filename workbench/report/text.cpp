#include "workbench/report/text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace workbench::report {

namespace {

constexpr int kDigits = 7;

void append_number(std::string& out, double value) {
  if (!std::isfinite(value)) {
    out += "null";
    return;
  }
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                 std::chars_format::general, kDigits);
  out.append(digits.data(), end.ptr);
}

/// The quoted JSON string, invalid UTF-8 replaced.
std::string quoted(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::string html(std::string_view text) {
  const std::string clean = nlohmann::json::parse(quoted(text)).get<std::string>();
  std::string out;
  out.reserve(clean.size());
  for (const char c : clean) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string json_string(std::string_view text) {
  std::string out;
  for (const char c : quoted(text)) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

std::string json_number(double value) {
  std::string out;
  append_number(out, value);
  return out;
}

std::string json_numbers(const std::vector<double>& values) {
  std::string out = "[";
  out.reserve(values.size() * 9 + 2);
  for (const double value : values) {
    if (out.size() > 1) out += ',';
    append_number(out, value);
  }
  return out + ']';
}

}  // namespace workbench::report
