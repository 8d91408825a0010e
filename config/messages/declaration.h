// The text of spoolwatch.lcm, as it is built into the program.
#pragma once

#include <string_view>

namespace config::messages {

[[nodiscard]] std::string_view declaration();

}  // namespace config::messages
