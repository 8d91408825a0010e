// The audit trail: one JSON line per operator command, executed or rejected, appended to
// FOLDER/audit.log; commands of users who may only query go to refused.log. At its size limit a
// file replaces its predecessor, audit.log.1 or refused.log.1. Rejections of one user are written
// at a limited rate; the next line of that user counts those left out ("not_listed").
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "daemon/io/background_writer.h"
#include "daemon/io/capped_file.h"

namespace monitor::io {

struct AuditEntry {
  std::int64_t utc_us = 0;
  unsigned uid = 0;
  std::string who;            ///< user name
  std::string what;           ///< the request as received
  std::string reject_reason;  ///< empty: executed
  bool may_act = true;
  std::int64_t not_listed = 0;  ///< earlier rejections of this user that have no line
};

/// One line, newline included.
[[nodiscard]] std::string print_audit(const AuditEntry& entry);

class Audit {
 public:
  /// `writer` must outlive this object; it also writes what is still queued then.
  Audit(const std::filesystem::path& folder, std::int64_t file_bytes, BackgroundWriter& writer);
  /// Writes the counts of rejections that have no line yet.
  ~Audit();
  Audit(const Audit&) = delete;
  Audit& operator=(const Audit&) = delete;

  /// Does not block on the disk.
  void note(AuditEntry entry);
  /// Lines that could not be written.
  [[nodiscard]] std::int64_t lost() const noexcept { return acts_->lost() + refused_->lost(); }

 private:
  /// Rejections of one user.
  struct Rejections {
    double allowed;
    std::int64_t utc_us;  ///< time of the newest one
    std::int64_t not_listed = 0;
    std::string who;
    bool may_act = true;
  };
  /// True when this rejection gets a line.
  bool lists(const AuditEntry& entry);
  void write(const AuditEntry& entry);

  std::shared_ptr<CappedFile> acts_;  ///< shared with the jobs of the writer
  std::shared_ptr<CappedFile> refused_;
  std::map<unsigned, Rejections> rejections_;  ///< by uid
  BackgroundWriter& writer_;
};

/// The user's name, or the uid when the user is unknown on this machine.
[[nodiscard]] std::string user_name(unsigned uid);

/// "2026-03-01T12:30:05.250Z".
[[nodiscard]] std::string utc_text(std::int64_t utc_us);

}  // namespace monitor::io
