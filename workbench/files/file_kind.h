// Record or TOML file, by content.
#pragma once

#include <string>

namespace workbench::files {

enum class FileKind {
  other,   ///< neither, unreadable, or no regular file
  record,  ///< CSV, MAT or LCM log
  toml,    ///< model or configuration
};

/// Reads the first lines only.
[[nodiscard]] FileKind kind_of(const std::string& file);

}  // namespace workbench::files
