// Names in a sentence.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

namespace config::schema {

/// "a, b, c".
[[nodiscard]] inline std::string joined(const std::vector<std::string>& names,
                                        std::string_view separator = ", ") {
  return fmt::format("{}", fmt::join(names, separator));
}

/// "a, b and c".
[[nodiscard]] inline std::string listed(const std::vector<std::string>& names,
                                        std::string_view last = "and") {
  if (names.size() < 2) return joined(names);
  return fmt::format("{} {} {}", fmt::join(names.begin(), names.end() - 1, ", "), last,
                     names.back());
}

}  // namespace config::schema
