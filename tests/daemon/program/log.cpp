#include "tests/daemon/program/log.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <sstream>

namespace program {
namespace {

std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

template <class Message>
void decode(const lcm::LogEvent& event, std::vector<Message>& into) {
  Message message;
  if (message.decode(event.data, 0, static_cast<unsigned>(event.datalen)) >= 0) {
    into.push_back(message);
  }
}

}  // namespace

std::string Log::timeline(const std::string& name, double sample_time_s) const {
  std::string text;
  for (const spoolwatch::alarm_t& alarm : alarms) {
    if (alarm.name != name || alarm.repeat) continue;
    char item[64];
    std::snprintf(item, sizeof item, "%.1f %s", static_cast<double>(alarm.tick) * sample_time_s,
                  alarm.active ? (alarm.direction > 0 ? "high" : "low") : "off");
    text += (text.empty() ? "" : ", ") + std::string(item);
  }
  return text;
}

Log read_log(const std::filesystem::path& folder) {
  Log log;
  for (const auto& file : files_of(folder)) {
    lcm::LogFile reader(file.string(), "r");
    if (!reader.good()) continue;
    while (const lcm::LogEvent* event = reader.readNextEvent()) {
      if (event->channel == "SPOOLWATCH_SAMPLE") decode(*event, log.samples);
      if (event->channel == "SPOOLWATCH_RODS") decode(*event, log.rods);
      if (event->channel == "SPOOLWATCH_PRESSURES") decode(*event, log.pressures);
      if (event->channel == "SPOOLWATCH_ESTIMATE") decode(*event, log.estimates);
      if (event->channel == "SPOOLWATCH_ALARM") decode(*event, log.alarms);
      if (event->channel == "SPOOLWATCH_HEALTH") decode(*event, log.healths);
    }
  }
  return log;
}

std::string bytes(const std::filesystem::path& folder) {
  std::ostringstream all;
  for (const auto& file : files_of(folder)) {
    all << file.filename().string() << '\n' << std::ifstream(file, std::ios::binary).rdbuf();
  }
  return all.str();
}

}  // namespace program
