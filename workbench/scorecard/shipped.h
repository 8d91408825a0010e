// The plan, methods and models of config/scorecard, built in.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace workbench::scorecard {

/// The text of a file by its name ("plan.toml"); none when there is no such file.
[[nodiscard]] std::optional<std::string_view> shipped_text(std::string_view name);

/// "scorecard/plan.toml", "models/thesis.toml": as they lie in config.
[[nodiscard]] std::vector<std::string> shipped_files();

/// File names of the methods, in the order of the alphabet.
[[nodiscard]] std::vector<std::string> shipped_methods();

}  // namespace workbench::scorecard
