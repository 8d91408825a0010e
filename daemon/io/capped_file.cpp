#include "daemon/io/capped_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <system_error>

namespace monitor::io {

bool CappedFile::try_append(const std::string& line) noexcept {
  std::error_code error;
  std::filesystem::create_directories(path_.parent_path(), error);
  const auto size = std::filesystem::file_size(path_, error);
  if (!error && static_cast<std::int64_t>(size + line.size()) > most_bytes_) {
    std::filesystem::rename(path_, path_.string() + ".1", error);
  }
  const int file = open(path_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0640);
  bool written = false;
  if (file >= 0) {
    // One write, rolled back on a full disk, so that no partial line remains.
    struct stat before {};
    const bool known = fstat(file, &before) == 0;
    const ssize_t n = write(file, line.data(), line.size());
    written = n == static_cast<ssize_t>(line.size()) && fsync(file) == 0;
    if (n >= 0 && !written && known && ftruncate(file, before.st_size) != 0) written = false;
    close(file);
  }
  return written;
}

}  // namespace monitor::io
