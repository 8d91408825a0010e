// Text as it may stand in HTML and in the JSON inside a script element.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace workbench::present {

/// Units and signs as printed: "um" with the micrometre sign, "m/s2", "m3" and "N s" with
/// exponents and a dot, "+-" and "->" as one sign, a minus before a digit, "5 %" not torn apart.
/// Names with underscores stay as they are.
[[nodiscard]] std::string typeset(std::string_view text);

/// & < > " ' as entities; bytes that are no UTF-8 become U+FFFD.
[[nodiscard]] std::string html(std::string_view text);

/// A JSON string with its quotes. "<" is \u003c, so that no </script> or <!-- can arise.
[[nodiscard]] std::string json_string(std::string_view text);

/// A JSON number of at most 7 significant digits; null for NaN and infinities.
[[nodiscard]] std::string json_number(double value);

[[nodiscard]] std::string json_numbers(const std::vector<double>& values);

// A command as it can be pasted into a shell.

/// The word in single quotes where a shell would not take it as it is.
[[nodiscard]] std::string shell_word(std::string_view word);

[[nodiscard]] std::string shell_command(const std::vector<std::string>& words);

}  // namespace workbench::present
