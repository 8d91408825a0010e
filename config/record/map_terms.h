// The right side of a mapping's pair: [-]column[*factor][+offset], or the rate of a file without
// times.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "config/record/column_words.h"

namespace config::record {

struct MapTerm {
  std::size_t column = 0;  ///< from 0
  double factor = 1.0;
  double offset = 0.0;
  bool stated = false;  ///< a factor or an offset is typed, be it 1 or 0
};

/// The column of that header, name or number. Throws schema::DataError at `where` for a name of
/// several columns.
[[nodiscard]] std::optional<std::size_t> column_named(const std::vector<ReadColumn>& columns,
                                                      const std::string& where,
                                                      const std::string& name);

/// None: no column is named. Throws as column_named() does.
[[nodiscard]] std::optional<MapTerm> map_term(const std::vector<ReadColumn>& columns,
                                              const std::string& where, const std::string& text);

/// "1000Hz", "2 ms": the period, s; 0: neither.
[[nodiscard]] double period_in(const std::string& text);

}  // namespace config::record
