// Files that are replaced together and can be brought back: FILE is the one in use, FILE.v1,
// FILE.v2, ... are those before it. A file that did not differ is kept all the same, so that a
// version is whole.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace workbench::promotion {

/// Versions of a file that are kept, beside the one in use.
inline constexpr int kKeptVersions = 20;

/// A file and what it is to hold.
struct Replacement {
  std::filesystem::path file;
  std::string text;
};

/// The newest version of which all files are there, 0 when there is none.
[[nodiscard]] int newest_version(const std::vector<std::filesystem::path>& files);

/// FILE.v3.
[[nodiscard]] std::filesystem::path version_of(const std::filesystem::path& file, int version);

/// Keeps the files as a new version and replaces them, each whole or not at all; then every version
/// but the newest kKeptVersions is removed. Returns the version. Throws config::schema::RunError;
/// then the files are as they were.
int replace(const std::vector<Replacement>& replacements);

/// Replaces all files or none; `copies` have what the files have now. Throws
/// config::schema::RunError; then the files are as they were, a copy in a file's place where
/// nothing else can be written.
void write_together(const std::vector<Replacement>& replacements,
                    const std::vector<std::filesystem::path>& copies);

/// Brings a version back; what was in use becomes FILE.withdrawn, the version stays until
/// use_up(). Throws config::schema::RunError; then the files are as they were.
void bring_back(const std::vector<std::filesystem::path>& files, int version);

/// Takes bring_back() back: FILE.withdrawn is in use again. Throws config::schema::RunError.
void withdraw(const std::vector<std::filesystem::path>& files, int version);

/// Removes a version that is in use again.
void use_up(const std::vector<std::filesystem::path>& files, int version);

/// The file's bytes. Throws config::schema::RunError.
[[nodiscard]] std::string read_whole(const std::filesystem::path& file);

}  // namespace workbench::promotion
