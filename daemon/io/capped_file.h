// A text file that grows by whole lines; at its size limit it replaces its predecessor, FILE.1.
#pragma once

#include <atomic>
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
  /// The same; returns false where nothing was written, for another try.
  [[nodiscard]] bool try_append(const std::string& line) noexcept;
  /// Counts a line that is not in the file.
  void lose() noexcept { ++lost_; }
  /// Lines that are not in the file. Any thread.
  [[nodiscard]] std::int64_t lost() const noexcept { return lost_; }

 private:
  const std::filesystem::path path_;
  const std::int64_t most_bytes_;
  std::atomic<std::int64_t> lost_{0};
};

}  // namespace monitor::io
