// The audit trail: one JSON line per operator command, executed or rejected, appended to
// FOLDER/audit.log. At its size limit the file replaces audit.log.1.
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
  std::string who;            ///< user name
  std::string what;           ///< the request as received
  std::string reject_reason;  ///< empty: executed
};

/// One line, newline included.
[[nodiscard]] std::string print_audit(const AuditEntry& entry);

class Audit {
 public:
  /// `writer` must outlive this object; it also writes what is still queued then.
  Audit(const std::filesystem::path& folder, std::int64_t file_bytes, BackgroundWriter& writer);

  /// Does not block on the disk.
  void note(const AuditEntry& entry);
  /// Lines that could not be written.
  [[nodiscard]] std::int64_t lost() const noexcept { return file_->lost; }

 private:
  /// Shared with the writer's jobs.
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

/// The user's name, or the uid when the user is unknown on this machine.
[[nodiscard]] std::string user_name(unsigned uid);

/// "2026-03-01T12:30:05.250Z".
[[nodiscard]] std::string utc_text(std::int64_t utc_us);

}  // namespace monitor::io
