// Two bounded buffers of byte records with all memory allocated at construction: a lock-free queue
// between two threads that rejects records when full, and a single-threaded backlog that overwrites
// its oldest record. A record is a 4-byte length and its bytes, wrapping around the end of the
// buffer.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace monitor::io {

/// One producer thread (push), one consumer thread (pop).
class ByteQueue {
 public:
  explicit ByteQueue(std::size_t capacity) : bytes_(capacity) {}

  /// Appends the record `first` + `second`; returns false when it does not fit.
  bool push(std::span<const std::uint8_t> head, std::span<const std::uint8_t> tail) noexcept;
  /// Replaces `record` by the oldest record; false when empty.
  bool pop(std::vector<std::uint8_t>& record);

 private:
  std::vector<std::uint8_t> bytes_;
  std::atomic<std::uint64_t> written_{0};  // bytes ever written
  std::atomic<std::uint64_t> read_{0};
};

/// One thread. Push drops the oldest records until the new one fits.
class ByteBacklog {
 public:
  explicit ByteBacklog(std::size_t capacity) : bytes_(capacity) {}

  /// Returns how many records were lost: the oldest ones, or this one when it is larger than all.
  std::int64_t push(std::span<const std::uint8_t> record);
  [[nodiscard]] bool empty() const noexcept { return begin_ == end_; }
  [[nodiscard]] std::int64_t records() const noexcept { return records_; }
  /// Replaces `record` by the one at `position` and returns the position after it; start with
  /// begin(), stop at end().
  std::uint64_t read(std::uint64_t position, std::vector<std::uint8_t>& record) const;
  [[nodiscard]] std::uint64_t begin() const noexcept { return begin_; }
  [[nodiscard]] std::uint64_t end() const noexcept { return end_; }
  /// Drops the oldest record.
  void drop_oldest();

 private:
  std::vector<std::uint8_t> bytes_;
  std::uint64_t begin_ = 0;  // bytes ever dropped
  std::uint64_t end_ = 0;    // bytes ever pushed
  std::int64_t records_ = 0;
};

}  // namespace monitor::io
