// An export as JSON, one object a line, and as MCAP.
#pragma once

#include <string>

#include "workbench/exchange/source.h"

namespace workbench::exchange {

/// The lines are what `spoolwatch bridge` sends: a time stamp in seconds and the values by topic.
[[nodiscard]] std::string json_lines(const std::string& input, const Kinds& kinds);

/// One MCAP channel for each topic. Its schema is what its first message has.
[[nodiscard]] std::string mcap_file(const std::string& input, const Kinds& kinds);

}  // namespace workbench::exchange
