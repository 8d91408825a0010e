#include "workbench/files/file_kind.h"

#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>

#include "config/record/mat_variables.h"
#include "config/record/readers.h"
#include "config/schema/read_file.h"

namespace workbench::files {
namespace {

constexpr int kComments = 1000;         // as many lines may stand above the first key
constexpr std::size_t kLongest = 4096;  // bytes of a line that is no comment
constexpr std::size_t kLooked[] = {8U << 10U, 256U << 10U,
                                   16U << 20U};  // bytes, more where need be

/// By the first line that says something; none: it is not in `begin`, the file's first bytes.
std::optional<FileKind> kind_by_line(const std::string& begin, bool whole) {
  static const std::regex toml_line(R"(\s*(\[|[\w."'-]+\s*=).*)");
  static const std::regex csv_line(R"([^=]*[,;\t][^=]*)");
  std::istringstream in(begin);
  std::string line;
  for (int i = 0; i < kComments && std::getline(in, line); ++i) {
    if (line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    const std::size_t first = line.find_first_not_of(" \t\r");
    const bool comment = first == std::string::npos || line[first] == '#';
    if (!comment && line.size() > kLongest) return FileKind::other;
    if (in.eof() && !whole) return std::nullopt;  // the line may go on
    if (comment) continue;
    if (line.starts_with("sep=") || line.starts_with("\"sep=")) continue;  // Excel's first line
    if (line.find('\0') != std::string::npos) return FileKind::other;
    if (std::regex_match(line, toml_line)) return FileKind::toml;
    return std::regex_match(line, csv_line) ? FileKind::record : FileKind::other;
  }
  return whole ? std::optional(FileKind::other) : std::nullopt;
}

}  // namespace

FileKind kind_of(const std::string& file) {
  for (const std::size_t bytes : kLooked) {
    const std::string begin = config::schema::read_head(file, bytes).text;
    const std::string_view head = std::string_view(begin).substr(0, 128);
    if (config::record::is_lcm_log(head) || config::record::is_mat_file(head) ||
        config::record::other_mat_format(head) != nullptr || config::record::is_utf16(head)) {
      return FileKind::record;
    }
    if (const auto kind = kind_by_line(begin, begin.size() < bytes)) return *kind;
  }
  return FileKind::other;
}

}  // namespace workbench::files
