// Text as it may stand in HTML.
#pragma once

#include <string>
#include <string_view>

namespace workbench::present {

/// Units and signs as printed: "um" with the micrometre sign, "m/s2", "m3" and "N s" with
/// exponents and a dot, "+-" and "->" as one sign, a minus before a digit, "5 %" not torn apart.
/// Names with underscores stay as they are.
[[nodiscard]] std::string typeset(std::string_view text);

/// & < > " ' as entities; bytes that are no UTF-8 become U+FFFD.
[[nodiscard]] std::string html(std::string_view text);

}  // namespace workbench::present
