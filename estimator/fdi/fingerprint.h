// Settings as one line, to compare and to show.
#pragma once

#include <string>
#include <string_view>

namespace estimator::fdi {

/// Printed TOML without schema_version and id.
[[nodiscard]] inline std::string one_line(std::string toml) {
  toml.erase(0, toml.find('\n') + 1);  // schema_version
  if (toml.starts_with("id = ")) toml.erase(0, toml.find('\n') + 1);
  for (char& c : toml) {
    if (c == '\n') c = ' ';
    if (c == '"') c = '\'';
  }
  while (!toml.empty() && toml.back() == ' ') toml.pop_back();
  return toml;
}

/// The first setting in which two such lines differ, "[table] key = value"; "none" where a line
/// lacks it.
struct FingerprintDifference {
  std::string found;
  std::string expected;
};
[[nodiscard]] FingerprintDifference difference(std::string_view found, std::string_view expected);

}  // namespace estimator::fdi
