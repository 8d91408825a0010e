// The model files of config/models and the configurations config/thesis_case*.toml inside the
// program, so that `reproduce` needs no files.
#pragma once

#include <string_view>

namespace workbench::reproduce {

/// TOML text of the shipped file of that name, without folder. Asserts that there is such a file.
[[nodiscard]] std::string_view shipped_model_text(std::string_view name);

}  // namespace workbench::reproduce
