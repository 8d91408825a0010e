// Scales beside units: "0.1 mm", "1/100 mm" and "10^-3 m" say what one count is. "mm*10", "x 0.1"
// and "[10 mm]" do not: the numbers may be multiplied, or to be multiplied, or the range is meant.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace config::record {

/// "0.1 mm": one count in the unit behind it.
struct UnitScale {
  double factor = 1.0;    ///< 0.1
  std::string_view unit;  ///< "mm"; empty: `text` begins with no scale of one reading
};

/// Reads a power of ten below one (0.1, 0,01, 1e-3, 10^-3, 10⁻³) or 1/n in front of a unit. The
/// view refers to `text`, which has superscripts written with ^.
[[nodiscard]] UnitScale unit_scale(std::string_view text);

/// "10^-3 m" for "10⁻³ m".
[[nodiscard]] std::string with_plain_exponents(std::string_view text);

/// Bytes of a unit with a scale; what is longer is none. It bounds the time that a long header
/// takes.
inline constexpr std::size_t kMostUnitBytes = 64;

/// True where a unit stands beside a scale of several readings: "mm*10", "mm/10", "x 0.1 mm",
/// "10 mm". `is_unit` says which texts are units.
[[nodiscard]] bool has_open_scale(std::string_view unit, bool (*is_unit)(std::string_view));

/// True where a name ends or begins with a scale: "Position x 0.1", "Position*10", "Pos (x10)".
[[nodiscard]] bool name_has_scale(std::string_view name);

}  // namespace config::record
