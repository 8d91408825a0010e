// Reads logs as every LCM tool does, through LCM's own lcm_eventlog.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <lcm/lcm-cpp.hpp>
#include <string>
#include <vector>

namespace monitor::io {

struct Event {
  std::int64_t number;
  std::int64_t utc_us;
  std::string channel;
  std::string data;
};

inline std::vector<Event> read_events(const std::filesystem::path& file) {
  std::vector<Event> events;
  lcm::LogFile log(file, "r");
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    events.push_back({event->eventnum, event->timestamp, event->channel,
                      std::string(static_cast<const char*>(event->data),
                                  static_cast<std::size_t>(event->datalen))});
  }
  return events;
}

inline std::vector<std::filesystem::path> logs_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files(std::filesystem::directory_iterator(folder), {});
  std::sort(files.begin(), files.end());
  return files;
}

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Size of an event in a log.
inline std::uintmax_t size_of(const Event& event) {
  return 28 + event.channel.size() + event.data.size();
}

}  // namespace monitor::io
