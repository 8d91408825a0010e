// Readings that no motion can have made: single samples far off their neighbours.
#pragma once

#include <cstddef>
#include <vector>

namespace config::record {

/// Indices of up to three samples in a row that leave the values around them and come back. `gaps`
/// as in Record: over these there are no neighbours.
[[nodiscard]] std::vector<std::size_t> find_outliers(const std::vector<double>& values,
                                                     const std::vector<std::size_t>& gaps);

}  // namespace config::record
