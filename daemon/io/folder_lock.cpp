#include "daemon/io/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "config/schema/error.h"

namespace monitor::io {
namespace {

using config::schema::bad_config;

config::schema::ConfigError unusable(const std::filesystem::path& folder, const std::string& key,
                                     const std::string& why) {
  return bad_config(key, "\"" + folder.string() + "\" cannot be written: " + why,
                    "a folder of the daemon's user, or \"\"");
}

}  // namespace

void check_writable(const std::filesystem::path& folder, const std::string& key) {
  std::error_code error;
  std::filesystem::path there = std::filesystem::absolute(folder, error);
  while (!std::filesystem::exists(there, error) && there.has_relative_path()) {
    there = there.parent_path();
  }
  if (!std::filesystem::is_directory(there, error)) {
    throw unusable(folder, key, there.string() + " is not a folder");
  }
  if (access(there.c_str(), W_OK | X_OK) != 0) {
    throw unusable(folder, key, there.string() + ": " + std::strerror(errno));
  }
}

FolderLock::~FolderLock() {
  for (const int descriptor : descriptors_) close(descriptor);
}

void FolderLock::claim(const std::filesystem::path& folder, const std::string& key) {
  if (folder.empty()) return;
  check_writable(folder, key);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw unusable(folder, key, error.message());
  const std::filesystem::path place = std::filesystem::canonical(folder, error);
  if (std::find(folders_.begin(), folders_.end(), place) != folders_.end()) return;
  const int descriptor = open(place.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) throw unusable(folder, key, std::strerror(errno));
  // Where the file system knows no locks there is no claim.
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(descriptor);
    throw config::schema::RunError(key + ": \"" + folder.string() +
                                   "\" is in use by another daemon; give each a folder of its own");
  }
  folders_.push_back(place);
  descriptors_.push_back(descriptor);
}

}  // namespace monitor::io
