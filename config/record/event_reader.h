// Reads the events of an LCM event log, one by one. liblcm's own reader trusts the lengths in the
// file, and one damaged byte there ends the program.
//
// Event: sync word EDA1DA01, number (8 bytes), time stamp (8), channel's length (4), data's length
// (4), channel, data; big endian.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace lcm {
struct LogEvent;
}

namespace config::record {

class EventReader {
 public:
  /// Throws schema::Error (exit 65) when the file cannot be read.
  explicit EventReader(const std::string& file);
  ~EventReader();

  /// The next event, its data valid until the next call; null at the end, and at an event that is
  /// not complete or not one.
  const lcm::LogEvent* next();
  /// End of the last complete event, bytes from the file's beginning.
  [[nodiscard]] std::int64_t complete() const noexcept;
  /// False when the file goes on after the last complete event.
  [[nodiscard]] bool at_end() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace config::record
