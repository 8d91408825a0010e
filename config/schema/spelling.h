// Mistyped names and the known names near them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace config::schema {

/// The nearest of `names` to a mistyped one, or "" when none is near (edit distance).
[[nodiscard]] std::string nearest(std::string_view typed, const std::vector<std::string>& names);

/// Throws UsageError for the first word of a command line that begins with "--" and is none of
/// `options`, with the near ones. `options` begin with "--"; a word may be "--name=value"; words
/// after a lone "--" are values. `place` begins the message: "" or "compare: ".
void require_known_options(const std::vector<std::string>& words,
                           const std::vector<std::string>& options, const std::string& place = "");

/// The same for the options of a CLI::App.
template <class App>
void require_known_options(const std::vector<std::string>& words, const App& app,
                           const std::string& place = "") {
  std::vector<std::string> options;
  for (const auto* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  require_known_options(words, options, place);
}

}  // namespace config::schema
