#include "workbench/present/script_json.h"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace workbench::present {
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

}  // namespace

std::string json_string(std::string_view text) {
  std::string out;
  const std::string quoted =
      nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (const char c : quoted) {
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

}  // namespace workbench::present
