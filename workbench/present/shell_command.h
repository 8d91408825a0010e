// A command as it can be pasted into a shell.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace workbench::present {

/// The word in single quotes where a shell would not take it as it is.
[[nodiscard]] std::string shell_word(std::string_view word);

[[nodiscard]] std::string shell_command(const std::vector<std::string>& words);

}  // namespace workbench::present
