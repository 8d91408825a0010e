// Why a column that fits the command best may be something else all the same.
#pragma once

#include <string>

#include "config/record/column_words.h"

namespace config::record {

/// "may be the command, or ...": the voltage, current, torque or force of what no known word names
/// ("Spring force [N]", "Fan voltage [V]"), or what a position loop is asked for ("Position command
/// [V]"). Empty: its words leave no doubt.
[[nodiscard]] std::string doubt_of_command(const ReadColumn& column);

}  // namespace config::record
