// A text file that grows by whole lines; at its size limit it replaces its predecessor, FILE.1.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

namespace monitor::io {

class CappedFile {
 public:
  CappedFile(std::filesystem::path file, std::int64_t most_bytes)
      : path_(std::move(file)), most_bytes_(most_bytes) {}

  /// Appends one line, newline included, and synchronises; one that cannot be written is lost. One
  /// thread at a time.
  void append(const std::string& line) noexcept {
    if (!try_append(line)) lose();
  }
  /// Appends whole lines, all or none, and synchronises; false: none, for another try. One thread
  /// at a time.
  [[nodiscard]] bool try_append(const std::string& lines) noexcept;
  /// Bytes of lines to append together, the first of `first_bytes`: what the file has room for, or
  /// a whole file where the first line has none. One thread at a time.
  [[nodiscard]] std::size_t room_bytes(std::size_t first_bytes) const noexcept;
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
  /// Counts a line that is not in the file.
  void lose() noexcept { ++lost_; }
  /// Lines that are not in the file. Any thread.
  [[nodiscard]] std::int64_t lost() const noexcept { return lost_; }

 private:
  /// Removes the part of a line that a failed write has left; false: the part is still there.
  bool cut_torn() noexcept;

  const std::filesystem::path path_;
  const std::int64_t most_bytes_;
  std::int64_t torn_at_ = -1;  ///< size of the file without that part; -1: there is none
  std::atomic<std::int64_t> lost_{0};
};

}  // namespace monitor::io
