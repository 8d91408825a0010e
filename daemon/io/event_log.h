// Writes LCM event logs; reports every failure and never leaves a partial event at the end of a
// file.
//
// An event: 4-byte sync word, 8-byte event number (from 0 in each file), 8-byte time in us, 4-byte
// channel length, 4-byte data length (all big-endian), channel, data (source: lcm/eventlog.c).
// lcm_eventlog_write_event uses a buffered FILE and cannot report which event a full disk
// truncated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace monitor::io {

/// Size of the header before an event's channel.
inline constexpr std::size_t kEventHeader = 28;
inline constexpr std::size_t kNumberAt = 4;     ///< offset of the event number in an event
inline constexpr std::size_t kMaxChannel = 63;  ///< LCM's own limit

/// Writes an event header with event number 0, a placeholder.
void put_event_header(std::span<std::uint8_t, kEventHeader> header, std::int64_t utc_us,
                      std::size_t channel_size, std::size_t data_size) noexcept;

/// A series of files FOLDER/spoolwatch-RUNID-NNNNN.lcmlog of limited size.
class EventLog {
 public:
  EventLog(std::filesystem::path folder, std::int64_t run_id, std::int64_t file_bytes,
           std::int64_t files);
  ~EventLog();
  EventLog(const EventLog&) = delete;
  EventLog& operator=(const EventLog&) = delete;

  /// Opens a file if none is open, recreating its folder if necessary; 0 or errno.
  int open();

  /// Adds an event (header from put_event_header, channel, data) to the batch for write(). False
  /// when the batch or the file is full: call write() and add it again.
  bool add(std::span<const std::uint8_t> event);

  struct Written {
    std::size_t events;  // whole events on disk, counted from the first of the batch
    int error;           // 0, or errno: the others are not on disk and must be added again
  };
  /// Writes the batch and clears it.
  Written write();

  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }

  /// Events of files that somebody removed while they were written.
  [[nodiscard]] std::int64_t removed() const noexcept { return removed_; }

 private:
  void close() noexcept;
  /// Closes a file that has been removed from its folder.
  void leave_removed() noexcept;
  void remove_oldest() const;

  const std::filesystem::path folder_;
  const std::int64_t run_id_;
  const std::int64_t file_bytes_;
  const std::int64_t files_;
  std::filesystem::path file_;
  int descriptor_ = -1;
  int number_ = 0;            // of the next file
  std::int64_t size_ = 0;     // of the open file: whole events
  std::int64_t events_ = 0;   // in the open file
  std::int64_t removed_ = 0;  // in files that were removed while they were open
  std::vector<std::uint8_t> batch_;
  std::vector<std::size_t> ends_;  // of each event in the batch
};

}  // namespace monitor::io
