#include "config/record/units.h"

#include <array>

namespace config::record {
namespace {

struct Unit {
  std::string_view suffix;
  std::string_view si;
  double factor;
};

constexpr double kPsi_Pa = 6894.757293168361;

constexpr std::array kUnits{
    Unit{"s", "s", 1.0},        Unit{"ms", "s", 1e-3},     Unit{"us", "s", 1e-6},
    Unit{"V", "V", 1.0},        Unit{"mV", "V", 1e-3},     Unit{"m", "m", 1.0},
    Unit{"cm", "m", 1e-2},      Unit{"mm", "m", 1e-3},     Unit{"um", "m", 1e-6},
    Unit{"mps", "mps", 1.0},    Unit{"mmps", "mps", 1e-3}, Unit{"Pa", "Pa", 1.0},
    Unit{"kPa", "Pa", 1e3},     Unit{"MPa", "Pa", 1e6},    Unit{"bar", "Pa", 1e5},
    Unit{"psi", "Pa", kPsi_Pa}, Unit{"N", "N", 1.0},       Unit{"kN", "N", 1e3},
};

}  // namespace

Column parse_column(std::string_view name) {
  const std::size_t underscore = name.rfind('_');
  if (underscore != std::string_view::npos && underscore > 0) {
    for (const Unit& unit : kUnits) {
      if (name.substr(underscore + 1) == unit.suffix) {
        const std::string stem(name.substr(0, underscore));
        return {stem, std::string(unit.si), stem + "_" + std::string(unit.si), unit.factor};
      }
    }
  }
  return {std::string(name), "", std::string(name), 1.0};
}

}  // namespace config::record
