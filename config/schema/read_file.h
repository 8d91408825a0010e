// Files that may be anything: read whole or refused, within a limit of size and time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace config::schema {

inline constexpr std::size_t kMiB = std::size_t{1} << 20U;
inline constexpr std::size_t kMostConfigurationBytes = 16 * kMiB;  ///< configurations and models
inline constexpr std::size_t kMostRecordBytes = 1024 * kMiB;

struct FileContent {
  std::string text;
  std::string wrong;  ///< why it cannot be read, in a few words; empty: `text` is the whole file
};

/// The beginning of a regular file, `most_bytes` of it at most. Whatever else is there (a pipe,
/// whose bytes come once, a device, a folder) is `wrong` and stays unread.
[[nodiscard]] FileContent read_head(const std::filesystem::path& file, std::size_t most_bytes);

/// Reads a file or a pipe; a pipe that nobody writes to is given up after ten seconds. Read errors,
/// folders, devices and files beyond the limit are `wrong`. Never throws for what the file is.
[[nodiscard]] FileContent read_file(const std::filesystem::path& file, std::size_t most_bytes);

}  // namespace config::schema
