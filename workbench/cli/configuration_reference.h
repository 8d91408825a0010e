#pragma once

#include <string>

namespace workbench::cli {

/// Markdown: every key of the files that `spoolwatch` reads, for scripts/reference.
[[nodiscard]] std::string configuration_reference();

}  // namespace workbench::cli
