// Nesting depth of the dotted keys of a TOML text. toml++ limits the depth of values but not of
// keys and destroys tables recursively: a key of many thousand parts would overflow the stack.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace config::schema {

/// Far above the depth of any shipped file.
inline constexpr std::size_t kMostKeyParts = 64;

/// Upper bound on the number of parts of any dotted key in `text`.
[[nodiscard]] inline std::size_t most_key_parts(std::string_view text) noexcept {
  std::size_t most = 0;
  std::size_t parts = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' || c == '\'') {  // a quoted part may hold anything but the end of the line
      while (++i < text.size() && text[i] != c && text[i] != '\n') {
        if (c == '"' && text[i] == '\\') ++i;
      }
    } else if (c == '#') {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if (c == '.') {
      most = std::max(most, ++parts + 1);
    } else if (c == '=' || c == '[' || c == '{' || c == ',' || c == '\n') {
      parts = 0;
    }
  }
  return most;
}

}  // namespace config::schema
