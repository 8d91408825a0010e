// Files that appear complete or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace config::record {

/// Writes `text` under a temporary name beside `file` and renames it; file and name are on the disk
/// when it returns. Where `file` is a link, the file that it leads to is written so, and the link
/// stays. A file that is replaced leaves its permissions, and its owner where that is allowed. A
/// device or a pipe is written to as it is. Throws schema::RunError.
void write_whole(const std::filesystem::path& file, std::string_view text);

}  // namespace config::record
