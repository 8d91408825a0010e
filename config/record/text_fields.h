// The fields of a line of text: where they begin and end, and which number stands in one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace config::record {

/// Blank, tab or carriage return.
[[nodiscard]] constexpr bool is_blank(char c) noexcept {
  return c == ' ' || c == '\t' || c == '\r';
}
[[nodiscard]] constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

/// U+2212, as word processors write a minus sign.
inline constexpr std::string_view kMinusSign = "\xE2\x88\x92";

/// Without blanks around.
[[nodiscard]] constexpr std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}
/// ASCII letters alone.
[[nodiscard]] std::string lower(std::string_view text);

/// Fields of a line without its end, quotes and blanks around removed.
[[nodiscard]] std::vector<std::string> split_fields(std::string_view line, char separator);

enum class FieldKind { number, missing, clock, text };

/// How "1,234" beside decimal points, or "1.234" beside decimal commas, counts: one group of three
/// digits may as well be the decimals of a number that is written the other way.
enum class LoneGroup { refused, thousands };

/// The number in `field`, without blanks around; groups of thousands may be set apart: 1,234.5,
/// 1.234,5, 1 234,5, 1'234.5. False: none.
[[nodiscard]] bool parse_number(std::string_view field, char decimal, double& value,
                                LoneGroup lone = LoneGroup::refused);

/// Empty, NaN, NA, #N/A, ...
[[nodiscard]] bool is_missing(std::string_view field);

}  // namespace config::record
