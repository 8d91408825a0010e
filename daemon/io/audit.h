// Who did what when: one JSON line for each order that somebody gave, done or refused, in a file
// that only grows, FOLDER/audit.log. At its size limit it becomes audit.log.1, in the place of the
// one before.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "daemon/io/background_writer.h"

namespace monitor::io {

struct AuditEntry {
  std::int64_t utc_us = 0;
  unsigned uid = 0;
  std::string who;            ///< the user's name
  std::string what;           ///< the request as it came
  std::string reject_reason;  ///< empty: done
};

/// One line with its end.
[[nodiscard]] std::string print_audit(const AuditEntry& entry);

class Audit {
 public:
  /// `writer` writes, also what is queued when this ends.
  Audit(const std::filesystem::path& folder, std::int64_t file_bytes, BackgroundWriter& writer);

  /// Does not wait for the disk.
  void note(const AuditEntry& entry);
  /// Lines that could not be written.
  [[nodiscard]] std::int64_t lost() const noexcept { return file_->lost; }

 private:
  /// What the writer's jobs write to; they share it.
  struct File {
    File(std::filesystem::path file, std::int64_t most) : path(std::move(file)), most_bytes(most) {}

    std::filesystem::path path;
    std::int64_t most_bytes;
    std::atomic<std::int64_t> lost{0};

    void append(const std::string& line) noexcept;
  };

  std::shared_ptr<File> file_;
  BackgroundWriter& writer_;
};

/// "ann", or the number when the user has no name here.
[[nodiscard]] std::string user_name(unsigned uid);

/// "2026-03-01T12:30:05.250Z".
[[nodiscard]] std::string utc_text(std::int64_t utc_us);

}  // namespace monitor::io
