// The model files of config/models inside the program, so that `reproduce` needs no files.
#pragma once

#include <string_view>

namespace workbench::reproduce {

/// TOML text of config/models/<name>. Asserts that there is such a file.
[[nodiscard]] std::string_view shipped_model_text(std::string_view name);

}  // namespace workbench::reproduce
