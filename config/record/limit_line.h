// Lines of limits, ranges or scales among names, units and numbers: "min;-10;-100",
// "[0..5];[-10..10];[-100..100]", "Scale;0.001;1".
#pragma once

#include <string>
#include <vector>

namespace config::record {

/// True where the fields are ranges and numbers, most of them ranges where a number is the first,
/// or where a first word says what the numbers behind it limit or scale. Empty fields count for
/// nothing.
[[nodiscard]] bool is_limit_line(const std::vector<std::string>& fields, char decimal);

}  // namespace config::record
