// Makes null the last command however the process ends: on leaving the scope and from a handler for
// every signal that would end the process.
#pragma once

#include <atomic>
#include <filesystem>
#include <iosfwd>

#include "daemon/daemon_config.h"
#include "hal/device.h"

namespace monitor {

/// Wraps the valve that the loop drives. After close(), a late command of another thread is
/// followed by null again. One instance at a time.
class SafeStateValve final : public hal::ValveDrive {
 public:
  /// `valve` may be null and must outlive this object.
  explicit SafeStateValve(hal::ValveDrive* valve) noexcept;
  ~SafeStateValve() override;
  SafeStateValve(const SafeStateValve&) = delete;
  SafeStateValve& operator=(const SafeStateValve&) = delete;

  /// The drive to hand to the loop; null without a valve.
  [[nodiscard]] hal::ValveDrive* valve() noexcept { return valve_ == nullptr ? nullptr : this; }
  /// Commands null now and after every later command.
  void close() noexcept;

  hal::Applied write(double u_V, const hal::Tick& tick) noexcept override;
  hal::Applied go_null() noexcept override;
  hal::Applied end_at_null() noexcept override;

 private:
  hal::ValveDrive* valve_;
  std::atomic<bool> closed_{false};
};

/// Makes a write to a broken pipe or past a file-size limit return an error instead of ending the
/// process.
void ignore_write_signals() noexcept;

/// The note that a running daemon leaves on disk, so that another process can command null after
/// the daemon was killed. A file with the effective configuration. The file exists from before the
/// first write to the valve until null has been the last command.
class SafeStateNote {
 public:
  /// Throws config::schema::RunError when it cannot be written. Empty `file`: no note.
  SafeStateNote(std::filesystem::path file, DaemonConfig& config);
  /// Removes the file; call once the valve is at null. A process that dies leaves the file behind.
  void withdraw() const;

 private:
  std::filesystem::path file_;
};

/// Opens only the valve, writes null and closes it, retrying for up to 2 s, and reports on `log`.
/// Does nothing where no valve can have been left away from null. Returns the exit code; throws
/// config::schema::Error when the valve cannot be opened.
int write_null(const DaemonConfig& config, std::ostream& log);

/// The same for the configuration in a daemon's note, which is removed on success. Without a note
/// nothing is written.
int write_null(const std::filesystem::path& note, std::ostream& log);

}  // namespace monitor
