// Reads the events of an LCM event log, one by one. liblcm's own reader trusts the lengths in the
// file, and one damaged byte there ends the program.
//
// Event: sync word EDA1DA01, number (8 bytes), time stamp (8), channel's length (4), data's length
// (4), channel, data; big endian.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

#include "config/messages/handler.h"
#include "config/schema/error.h"

namespace config::record {

struct LogEvent {
  std::int64_t number = 0;
  std::string channel;
  std::string data;

  [[nodiscard]] int size() const noexcept { return static_cast<int>(data.size()); }
};

class LogReader {
 public:
  /// Throws schema::DataError when the file cannot be read.
  explicit LogReader(const std::string& file);

  /// The next event, valid until the next call; null at the end, and at an event that is not
  /// complete or not one. Throws schema::DataError when the file cannot be read on.
  const LogEvent* next();
  /// The newest of them.
  [[nodiscard]] const LogEvent& event() const noexcept { return event_; }
  /// Hands the newest event over as a message of this kind. Throws schema::DataError when it
  /// is of another type.
  void deliver(messages::MessageKind kind, messages::MessageHandler& handler) const;
  /// The error that deliver() throws.
  [[nodiscard]] schema::DataError wrong_type(messages::MessageKind kind) const;
  /// "FILE: event N", of the newest one.
  [[nodiscard]] std::string where() const;

  /// End of the last complete event, bytes from the file's beginning.
  [[nodiscard]] std::int64_t complete() const noexcept { return complete_; }
  /// False when the file goes on after the last complete event.
  [[nodiscard]] bool at_end() const noexcept { return complete_ >= size_; }

 private:
  bool read_event();

  std::string file_;
  std::ifstream in_;
  std::int64_t size_ = 0;
  std::int64_t complete_ = 0;
  LogEvent event_;
};

}  // namespace config::record
