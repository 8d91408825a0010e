// The command lines that do what a study's steps do.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "workbench/present/shell_command.h"

namespace workbench::serve {

[[nodiscard]] inline std::string stem(const std::string& file) {
  return std::filesystem::path(file).stem().string();
}

[[nodiscard]] inline std::string command_of(const std::vector<std::string>& words) {
  return present::shell_command(words);
}

/// Appends `--ignore SPAN` for every span.
inline void add_ignored(std::vector<std::string>& words, const std::vector<std::string>& spans) {
  for (const std::string& span : spans) {
    words.emplace_back("--ignore");
    words.push_back(span);
  }
}

}  // namespace workbench::serve
