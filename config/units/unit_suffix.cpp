#include "config/units/unit_suffix.h"

#include <utility>

namespace config::units {
namespace {

/// "N" of "N", "s2" of "s2", "m3/s" of "m3ps"; "" when it is no unit.
std::string unit_word(std::string_view word) {
  static constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
      {"m3ps", "m3/s"}, {"mps", "m/s"}, {"rad", "rad"}, {"Pa", "Pa"}, {"kg", "kg"},
      {"Hz", "Hz"},     {"N", "N"},     {"V", "V"},     {"m", "m"},   {"s", "s"}};
  for (const auto& [name, unit] : kUnits) {
    if (word == name) return std::string(unit);
    const bool power = word.size() == name.size() + 1 && word.starts_with(name) &&
                       word.back() >= '2' && word.back() <= '9' && unit == name;
    if (power) return std::string(word);
  }
  return "";
}

}  // namespace

std::string unit_of(std::string_view name) {
  // From the end, words that are units; one "per" among them divides. The first word is the name.
  std::string unit;
  std::string below;
  bool divided = false;
  for (std::size_t bar = name.rfind('_'); bar != std::string_view::npos && bar > 0;
       bar = name.rfind('_')) {
    const std::string_view word = name.substr(bar + 1);
    if (word == "per" && !divided && !unit.empty()) {
      divided = true;
      std::swap(unit, below);
    } else {
      std::string one = unit_word(word);
      if (one.empty()) break;
      if (!unit.empty()) one.append(" ").append(unit);
      unit = std::move(one);
    }
    name = name.substr(0, bar);
  }
  if (!divided) return unit;
  if (unit.empty()) return "1/" + below;
  const bool compound = below.find_first_of(" /") != std::string::npos;
  return unit + "/" + (compound && below != "s" ? "(" + below + ")" : below);
}

}  // namespace config::units
