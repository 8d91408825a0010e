// Column names with unit suffixes: "y_mm" is the quantity y in millimetres.
#pragma once

#include <string>
#include <string_view>

namespace config::record {

struct Column {
  std::string stem;     ///< "y" of "y_mm"
  std::string si_unit;  ///< "m" of "y_mm"; "" when the suffix is no known unit
  std::string si_name;  ///< "y_m"; the whole name when the suffix is no known unit
  double factor = 1.0;  ///< SI value = factor * value in the file
};

[[nodiscard]] Column parse_column(std::string_view name);

}  // namespace config::record
