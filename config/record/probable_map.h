// For the refusal of a file: its columns, and the mapping that would probably be right.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "config/record/column_words.h"

namespace config::record {

/// "it has: 1 Time, 2 Command [V], ..."
[[nodiscard]] std::string listing(const FileHead& head, const std::vector<ReadColumn>& columns);

/// "'t=Time,u=Command,y=3[mm]'". `known` are the columns of time, command and position that are
/// found already; the others are those whose units, words and values fit best, `taken` excepted,
/// which have a use already. `has_rate`: without a time. `stated_step_s`: the period that the file
/// states; 0: none. Empty with fewer than two columns.
[[nodiscard]] std::string probable_map(const std::vector<ReadColumn>& columns,
                                       const std::array<std::optional<std::size_t>, 3>& known,
                                       const std::set<std::size_t>& taken, bool has_rate,
                                       double stated_step_s);

}  // namespace config::record
