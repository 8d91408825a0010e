// The place of a file that is to be written, and what keeps it there: links are followed, devices
// and pipes are left in their place, permissions stay, a new name is on the disk.
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <string_view>

namespace config::record {

/// A device or a pipe (/dev/stdout, /dev/null): nothing may be put in its place.
[[nodiscard]] bool is_special(const std::filesystem::path& file);

/// The file that a chain of links leads to, which need not exist. Throws schema::RunError for a
/// chain without an end.
[[nodiscard]] std::filesystem::path behind_links(const std::filesystem::path& file);

/// Gives the owner and the permissions of the file `like`, as far as the file system allows.
void keep_access(int file, const struct stat& like);

/// Writes all of a text; returns zero or the error (errno).
[[nodiscard]] int write_error(int file, std::string_view text);

/// Brings a file to the disk; returns zero or the error of a file system that can sync.
[[nodiscard]] int sync_error(int file);

/// Brings the names in a folder to the disk; returns zero or the error.
[[nodiscard]] int sync_folder(const std::filesystem::path& folder);

}  // namespace config::record
