// Units as people write them in headers: "mm", "[bar]", "1/min", "N m", "°".
#pragma once

#include <string>
#include <string_view>

namespace config::record {

inline constexpr double kPsi_Pa = 6894.757293168361;

struct UnitText {
  std::string text;     ///< as in the file, without brackets
  std::string si;       ///< ending of a column's name in SI: "m", "Pa", "m3ps", "rad", "pct"
  double factor = 1.0;  ///< SI value = factor * value in the file

  [[nodiscard]] bool known() const noexcept { return !si.empty(); }
};

/// `text` may stand in brackets of any kind. Unknown units have an empty `si`. Upper and lower case
/// count where they distinguish units (mPa, MPa; S, s). A scale of one reading (unit_scale.h) may
/// stand in front: "0.1 mm".
[[nodiscard]] UnitText parse_unit(std::string_view text);

/// The same without scales.
[[nodiscard]] UnitText parse_plain_unit(std::string_view text);

/// True for a known unit beside a scale of several readings: "mm*10".
[[nodiscard]] bool is_scaled_unit(std::string_view text);

/// "N m" for "Nm", "%" for "pct", "m3/s" for "m3ps": as text, from the ending of a column's name.
[[nodiscard]] std::string unit_words(std::string_view si);

/// A column's name and what its header says of the unit.
struct HeaderText {
  std::string name;     ///< "Position" of "Position [mm]"
  UnitText unit;        ///< text empty: none is named
  bool scaled = false;  ///< a scale of several readings: `name` is the whole header, without a unit
};

/// "Position [mm]", "Position (mm)", "Position / mm", "Position, mm", "Position in mm",
/// "Position mm", "position_mm", "Position_mm_" (as MATLAB renames "Position (mm)").
[[nodiscard]] HeaderText parse_header(std::string_view header);

/// The allowed values, for messages, where two units are named for a column.
[[nodiscard]] std::string one_unit_or_map(const std::string& column, const std::string& unit);

/// Names alike but for case, blanks and punctuation are equal: "Valve cmd" and "valve_cmd".
[[nodiscard]] std::string folded(std::string_view name);

/// Bytes that are no UTF-8 (RFC 3629) are Latin-1 and become UTF-8.
[[nodiscard]] std::string utf8_text(std::string_view text);

/// The first `bytes` of a UTF-8 text, or less: no character is cut.
[[nodiscard]] std::string_view cut_text(std::string_view text, std::size_t bytes);

/// Without blanks around, quotes and control characters; Latin-1 bytes become UTF-8.
[[nodiscard]] std::string clean_text(std::string_view text);

}  // namespace config::record
