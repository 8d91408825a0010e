// The form of the project's own files: the first line has time, command and position by their
// names, commas separate the columns.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "config/record/text_form.h"

namespace config::record {

/// None for any other text, for cells that need a closer look (units, quoted numbers with commas)
/// and for lines between names and numbers. `text`: that of the lines.
[[nodiscard]] std::optional<TextForm> own_form(std::string_view text,
                                               const std::vector<TextLine>& lines);

}  // namespace config::record
