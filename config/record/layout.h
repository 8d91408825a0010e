// Assigns the columns of a file to the fields of a record, for every form of file that names them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace config::record {

struct Layout;

struct RecordColumn {
  std::string stem;     ///< "y" of "y_mm"
  std::string si_unit;  ///< "m" of "y_mm"; "" when the suffix is no known unit
  std::string si_name;  ///< "y_m"; the whole name when the suffix is no known unit
  double factor = 1.0;  ///< SI value = factor * value in the file
};

[[nodiscard]] RecordColumn parse_column(std::string_view name);

[[nodiscard]] bool is_time(const RecordColumn& column);
/// Time, command or position, whatever the unit.
[[nodiscard]] bool is_main(const RecordColumn& column);

/// Columns t_s, u_V and y_m with their units, by name, and every further one; none where one of the
/// three is missing. A column without a name is left out. `units`: those beside the names, of a
/// line or of the cells, one per column, empty: none; a further column without a unit in its name
/// has this one. Throws schema::DataError at `where` for a name or a quantity that is there twice,
/// and for a column with two units.
[[nodiscard]] std::optional<Layout> plain_layout(const std::vector<std::string>& names,
                                                 const std::vector<std::string>& units,
                                                 const std::string& where);

/// Largest magnitude that a quantity of this SI unit has on any machine; infinite for other units.
/// A value beyond it is a defect of the file, and its square would overflow the sums of an
/// estimate.
[[nodiscard]] double largest_plausible(std::string_view si_unit) noexcept;
/// "magnitudes up to 1e+06 m"
[[nodiscard]] std::string plausible_range(std::string_view si_unit);

/// In quotes, cut to what fits into a message, control characters replaced.
[[nodiscard]] std::string quoted(std::string_view text);

}  // namespace config::record
