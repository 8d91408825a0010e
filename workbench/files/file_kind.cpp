#include "workbench/files/file_kind.h"

#include <fstream>
#include <regex>
#include <string_view>

#include "config/record/mat_variables.h"
#include "config/record/readers.h"

namespace workbench::files {

FileKind kind_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  char bytes[128] = {};
  in.read(bytes, sizeof bytes);
  const std::string_view head(bytes, static_cast<std::size_t>(in.gcount()));
  if (config::record::is_lcm_log(head) || config::record::is_mat_file(head) ||
      config::record::other_mat_format(head) != nullptr) {
    return FileKind::record;
  }
  in.clear();
  in.seekg(0);
  static const std::regex toml_line(R"(\s*(\[|[\w."'-]+\s*=).*)");
  static const std::regex csv_line(R"([^=]*,[^=]*)");
  constexpr int kComments = 1000;  // as many lines may stand above the first key
  constexpr std::size_t kLongest = 4096;
  std::string line;
  for (int i = 0; i < kComments && std::getline(in, line); ++i) {
    if (line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    if (line.starts_with("sep=") || line.starts_with("\"sep=")) continue;  // Excel's first line
    if (line.size() > kLongest || line.find('\0') != std::string::npos) return FileKind::other;
    if (std::regex_match(line, toml_line)) return FileKind::toml;
    return std::regex_match(line, csv_line) ? FileKind::record : FileKind::other;
  }
  return FileKind::other;
}

}  // namespace workbench::files
