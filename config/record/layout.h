// Assigns the columns of a file to the fields of a record, for every form of file that names them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/record/record.h"

namespace config::record {

struct RecordColumn {
  std::string stem;     ///< "y" of "y_mm"
  std::string si_unit;  ///< "m" of "y_mm"; "" when the suffix is no known unit
  std::string si_name;  ///< "y_m"; the whole name when the suffix is no known unit
  double factor = 1.0;  ///< SI value = factor * value in the file
};

[[nodiscard]] RecordColumn parse_column(std::string_view name);

/// One column on its way in.
struct Target {
  std::string name;  ///< as in the file
  double factor = 1.0;
  std::vector<double>* values = nullptr;  ///< within the record
  bool may_be_missing = false;            ///< NaN stands for a missing value
  std::string si_unit{};                  ///< "" when unknown
};

/// Largest magnitude that a quantity of this SI unit has on any machine; infinite for other units.
/// A value beyond it is a defect of the file, and its square would overflow the sums of an
/// estimate.
[[nodiscard]] double largest_plausible(std::string_view si_unit) noexcept;
/// "magnitudes up to 1e+06 m"
[[nodiscard]] std::string plausible_range(std::string_view si_unit);

[[nodiscard]] bool is_time(const RecordColumn& column);
/// Time, command or position, whatever the unit.
[[nodiscard]] bool is_main(const RecordColumn& column);

/// Time, command and position by their stem, anything else as a further column of `record`, which
/// must not be moved afterwards. Throws schema::DataError at `where` for a name that is
/// there twice, a wrong unit or none.
[[nodiscard]] std::vector<Target> lay_out(const std::vector<std::string>& names,
                                          const std::string& where, Record& record);

struct MissingColumn {
  const char* what;     ///< "time"
  const char* allowed;  ///< names for it
};

/// The first of time, command and position that no target fills, or null.
[[nodiscard]] const MissingColumn* first_missing(const std::vector<Target>& targets,
                                                 const Record& record);

/// In quotes, cut to what fits into a message, control characters replaced.
[[nodiscard]] std::string quoted(std::string_view text);

}  // namespace config::record
