// A folder that one daemon writes to: checked at the start, and claimed so that no second daemon
// removes or overwrites what the first one keeps there. The kernel releases the claim with the
// process.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace monitor::io {

/// Throws config::schema::ConfigError ("KEY: ...") where the folder, or the nearest one above it
/// that exists, cannot be written. Makes nothing.
void check_writable(const std::filesystem::path& folder, const std::string& key);

class FolderLock {
 public:
  FolderLock() = default;
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Makes the folder where there is none and claims it; a folder that this object has claimed
  /// already is passed over, and so is "". Throws config::schema::ConfigError for one that cannot
  /// be written, RunError for one of another daemon.
  void claim(const std::filesystem::path& folder, const std::string& key);

 private:
  std::vector<std::filesystem::path> folders_;
  std::vector<int> descriptors_;
};

}  // namespace monitor::io
