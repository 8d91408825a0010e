#include "estimator/structure.h"

#include <array>
#include <cctype>
#include <charconv>
#include <optional>

#include "config/schema/error.h"

namespace estimator {
namespace {

using Numbers = std::array<int, 3>;

/// "211"
std::optional<Numbers> digits(std::string_view text) {
  if (text.size() != 3) return std::nullopt;
  Numbers out{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::isdigit(static_cast<unsigned char>(text[i])) == 0) return std::nullopt;
    out[i] = text[i] - '0';
  }
  return out;
}

/// "(10,2,1)", blanks allowed after commas
std::optional<Numbers> list(std::string_view text) {
  if (text.size() < 2 || text.front() != '(' || text.back() != ')') return std::nullopt;
  const char* at = text.data() + 1;
  const char* const end = text.data() + text.size() - 1;
  Numbers out{};
  for (std::size_t i = 0; i < 3; ++i) {
    while (at < end && *at == ' ') ++at;
    const auto [next, error] = std::from_chars(at, end, out[i]);
    if (error != std::errc{}) return std::nullopt;
    at = next;
    if (i < 2 && (at == end || *at++ != ',')) return std::nullopt;
  }
  return at == end ? std::optional(out) : std::nullopt;
}

bool in_range(const Numbers& v) {
  return v[0] >= 0 && v[0] <= kMaxOrder && v[1] >= 0 && v[1] <= kMaxOrder && v[0] + v[1] >= 1 &&
         v[2] >= 0 && v[2] <= kMaxDelay;
}

}  // namespace

std::vector<std::string> Structure::names() const {
  std::vector<std::string> out;
  for (int i = 1; i <= n; ++i) out.push_back("a" + std::to_string(i));
  for (int i = 1; i <= m; ++i) out.push_back("b" + std::to_string(i));
  if (constant) out.emplace_back("constant");
  return out;
}

std::string Structure::text() const {
  const bool wide = n > 9 || m > 9 || k > 9;
  const char* const between = wide ? "," : "";
  return std::string("arx") + (wide ? "(" : "") + std::to_string(n) + between + std::to_string(m) +
         between + std::to_string(k) + (wide ? ")" : "");
}

Structure parse_structure(std::string_view text, bool constant) {
  std::string lower;
  for (const char c : text) {
    lower.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  }
  if (lower.starts_with("arx")) {
    const std::string_view rest = std::string_view(lower).substr(3);
    auto numbers = digits(rest);
    if (!numbers) numbers = list(rest);
    if (numbers && in_range(*numbers)) {
      return {(*numbers)[0], (*numbers)[1], (*numbers)[2], constant};
    }
  }
  throw config::schema::UsageError("structure: unknown \"" + std::string(text) +
                                   "\"; allowed: arxNMK as in arx211, or arx(N,M,K) with orders N, "
                                   "M 0 to 10 and delay K 0 to 50");
}

}  // namespace estimator
