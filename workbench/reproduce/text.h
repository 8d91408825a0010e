// printf into a string, for notes.
#pragma once

#include <string>

namespace workbench::reproduce {

[[nodiscard, gnu::format(printf, 1, 2)]] std::string text(const char* format, ...);

}  // namespace workbench::reproduce
