// Numbers that stand for a missing position: many loggers write -9999 and the like.
#pragma once

#include <cstddef>
#include <vector>

namespace config::record {

/// Rows whose value is +-999, +-9999 or +-99999 (in the file's unit, m or mm) and ten times farther
/// off than all values that are none of these. Without such values nothing is missing: a position
/// may rest at 0.999 m. `m_per_unit`: value in m = m_per_unit * value in the file; NaN is no value.
[[nodiscard]] std::vector<std::size_t> find_missing_marks(const std::vector<double>& values,
                                                          double m_per_unit);

}  // namespace config::record
