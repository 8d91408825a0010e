// JSON as it may stand inside a script element of a page.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace workbench::present {

/// A JSON string with its quotes. "<" is \u003c, so that no </script> or <!-- can arise.
[[nodiscard]] std::string json_string(std::string_view text);

/// A JSON number of at most 7 significant digits; null for NaN and infinities.
[[nodiscard]] std::string json_number(double value);

[[nodiscard]] std::string json_numbers(const std::vector<double>& values);

}  // namespace workbench::present
