#pragma once

#include <string>

namespace monitor {

/// Markdown: every key of the daemon's configuration and of calibration files, for
/// scripts/reference.
[[nodiscard]] std::string configuration_reference();

}  // namespace monitor
