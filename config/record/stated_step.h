// The sampling period that lines above a table state: "dt [s]: 0.005", "Sample Rate;200 Hz",
// "Increment" above 5e-3.
#pragma once

#include <cstddef>
#include <vector>

#include "config/record/text_table.h"

namespace config::record {

/// The period, s, in the first `end` lines; 0: none. It serves a proposal: the words may mean
/// another quantity.
[[nodiscard]] double stated_step_s(const std::vector<TextLine>& lines, std::size_t end,
                                   const TextDialect& dialect);

}  // namespace config::record
