#include "workbench/serve/page_files.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <string>

#include "workbench/serve/page_texts.h"

namespace workbench::serve {
namespace {

constexpr const char* kHtml = "text/html; charset=utf-8";
constexpr const char* kScriptType = "text/javascript; charset=utf-8";
constexpr const char* kSheet = "text/css; charset=utf-8";
constexpr const char* kText = "text/plain; charset=utf-8";
constexpr std::string_view kIcon =
    "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 16 16'><path d='M1 9h3l2-6 4 11 2-5h3' "
    "fill='none' stroke='#1673c5' stroke-width='2'/></svg>";

std::string_view icon() { return kIcon; }

struct Entry {
  std::string_view path;
  const char* type;
  std::string_view (*text)();
};

constexpr std::array kEntries{Entry{"/", kHtml, page_index},
                              Entry{"/style.css", kSheet, page_sheet},
                              Entry{"/app.js", kScriptType, page_app},
                              Entry{"/server.js", kScriptType, page_server},
                              Entry{"/stream.js", kScriptType, page_stream},
                              Entry{"/plots.js", kScriptType, page_plots},
                              Entry{"/curves.js", kScriptType, page_curves},
                              Entry{"/workbench.js", kScriptType, page_workbench},
                              Entry{"/make.js", kScriptType, page_make},
                              Entry{"/sliders.js", kScriptType, page_sliders},
                              Entry{"/ladder.js", kScriptType, page_ladder},
                              Entry{"/laws.js", kScriptType, page_laws},
                              Entry{"/result.js", kScriptType, page_result},
                              Entry{"/live.js", kScriptType, page_live},
                              Entry{"/ring.js", kScriptType, page_ring},
                              Entry{"/trigger.js", kScriptType, page_trigger},
                              Entry{"/read_as.js", kScriptType, page_read_as},
                              Entry{"/touch.js", kScriptType, page_touch},
                              Entry{"/alarms.js", kScriptType, page_alarms},
                              Entry{"/uplot.js", kScriptType, library_uplot},
                              Entry{"/uplot.css", kSheet, library_uplot_sheet},
                              Entry{"/preact.js", kScriptType, library_preact},
                              Entry{"/licences.txt", kText, library_licences},
                              Entry{"/icon.svg", "image/svg+xml", icon}};

/// FNV-1a of all files.
std::string build() {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const Entry& entry : kEntries) {
    for (const char c : entry.text()) {
      hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
    }
  }
  return fmt::format("{:016x}", hash);
}

const std::string& folder_of_build() {
  static const std::string folder = "/" + build();
  return folder;
}

std::string index_text() {
  constexpr std::string_view kPlace = "/BUILD";
  std::string text(page_index());
  for (auto at = text.find(kPlace); at != std::string::npos; at = text.find(kPlace, at + 1)) {
    text.replace(at, kPlace.size(), folder_of_build());
  }
  return text;
}

}  // namespace

std::optional<PageFile> page_file(std::string_view path) {
  static const std::string index = index_text();
  if (path == "/") return PageFile{kHtml, index};
  const bool lasting = path.starts_with(folder_of_build() + "/");
  if (lasting) path.remove_prefix(folder_of_build().size());
  for (const Entry& entry : kEntries) {
    if (entry.path == path && path != "/") return PageFile{entry.type, entry.text(), lasting};
  }
  return std::nullopt;
}

std::string missing_page_files() {
  if (!library_uplot().empty() && !library_preact().empty()) return {};
  return "the page was left out of this build: its libraries come from the npm registry "
         "(scripts/web-assets), which was not at hand";
}

}  // namespace workbench::serve
