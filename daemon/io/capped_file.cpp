#include "daemon/io/capped_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <system_error>

namespace monitor::io {

bool CappedFile::cut_torn() noexcept {
  if (torn_at_ < 0) return true;
  std::error_code error;
  const auto whole = static_cast<std::uintmax_t>(torn_at_);
  const auto size = std::filesystem::file_size(path_, error);
  if (!error && size > whole) std::filesystem::resize_file(path_, whole, error);
  if (error && error != std::errc::no_such_file_or_directory) return false;
  torn_at_ = -1;
  return true;
}

std::size_t CappedFile::room_bytes(std::size_t first_bytes) const noexcept {
  std::error_code error;
  const auto most = static_cast<std::size_t>(most_bytes_);
  const auto size = std::filesystem::file_size(path_, error);
  return error || size + first_bytes > most ? most : most - size;
}

bool CappedFile::try_append(const std::string& lines) noexcept {
  std::error_code error;
  std::filesystem::create_directories(path_.parent_path(), error);
  if (!cut_torn()) return false;
  const auto size = std::filesystem::file_size(path_, error);
  if (!error && static_cast<std::int64_t>(size + lines.size()) > most_bytes_) {
    std::filesystem::rename(path_, path_.string() + ".1", error);
  }
  const int file = open(path_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0640);
  bool written = false;
  if (file >= 0) {
    // One write, rolled back on a full disk, so that no partial line remains.
    struct stat before {};
    const bool known = fstat(file, &before) == 0;
    const ssize_t n = write(file, lines.data(), lines.size());
    written = n == static_cast<ssize_t>(lines.size()) && fsync(file) == 0;
    if (n > 0 && !written && known && ftruncate(file, before.st_size) != 0) {
      torn_at_ = before.st_size;
    }
    close(file);
  }
  return written;
}

}  // namespace monitor::io
