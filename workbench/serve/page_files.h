// The files that make the page, built into the program: its own, and two libraries from the npm
// registry (scripts/web-assets) that a build machine without access to it goes without.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace workbench::serve {

struct PageFile {
  const char* type;
  std::string_view text;
  bool lasting = false;  ///< what a browser has under this path is the same for ever
};

/// The file under a path such as "/workbench.js"; "/" is the page itself. It names the others under
/// "/BUILD/workbench.js", where BUILD is a hash of all of them: every further window of a browser
/// takes them from its cache.
[[nodiscard]] std::optional<PageFile> page_file(std::string_view path);

/// One line that names the files that the page lacks; empty where none is missing.
[[nodiscard]] std::string missing_page_files();

}  // namespace workbench::serve
