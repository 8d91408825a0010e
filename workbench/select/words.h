// Numbers and methods in words, as the table and the reasons have them.
#pragma once

#include <string>

namespace workbench::select {

/// So many significant digits, "-" for a missing value, no exponent between 1e-3 and 1e6.
[[nodiscard]] std::string number_words(double value, int digits);
/// 1.05: "5 % more than"; 3: "3 times".
[[nodiscard]] std::string more_words(double ratio);
/// "RLS" -> "recursive least squares".
[[nodiscard]] std::string method_words(const std::string& method);

}  // namespace workbench::select
