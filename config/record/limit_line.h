// Lines of limits, ranges or factors among names, units and numbers: "min;-10;-100",
// "[0..5];[-10..10];[-100..100]", "Factor;1;0.001".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace config::record {

/// True where the fields are ranges and numbers, most of them ranges where a number is the first,
/// or where a first word says what the numbers behind it limit or scale. Empty fields count for
/// nothing.
[[nodiscard]] bool is_limit_line(const std::vector<std::string>& fields, char decimal);

/// For each field, "'Faktor' '0.001'" where the line states anything but a factor of 1 or an
/// offset of 0; empty where not. No element for a line of another kind.
[[nodiscard]] std::vector<std::string> stated_factors(const std::vector<std::string>& fields,
                                                      char decimal);

/// True for a line of however many fields that states a factor other than 1 or an offset other than
/// 0: "Faktor Weg;0.1", "Faktor Weg = 0.1", "Faktor Weg 0.1", "Kanal 3;Faktor;0.1".
[[nodiscard]] bool states_factor(std::string_view line, char separator, char decimal);

}  // namespace config::record
