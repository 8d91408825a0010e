#include "config/record/lcm_reader.h"

#include <cmath>
#include <cstdint>
#include <lcm/lcm-cpp.hpp>
#include <limits>
#include <map>

#include "config/messages/decode.h"
#include "config/record/event_reader.h"
#include "config/record/sample_columns.h"
#include "config/record/time_grid.h"
#include "config/schema/error.h"
#include "spoolwatch/sample_t.hpp"

namespace config::record {
namespace {

using schema::bad_data;
using spoolwatch::sample_t;

constexpr std::string_view kSyncWord = "\xED\xA1\xDA\x01";
constexpr std::string_view kSampleEnding = "_SAMPLE";
constexpr std::int8_t kStaleQuality = 2;  // and 3, bad: no new reading

bool is_sample(const lcm::LogEvent& event) {
  std::int64_t hash = 0;
  return __int64_t_decode_array(event.data, 0, event.datalen, &hash, 1) > 0 &&
         hash == sample_t::getHash();
}

/// The channel to read: the one named, or the only one of the right type.
std::string choose_channel(const std::string& file, std::string_view wanted) {
  EventReader log(file);
  std::map<std::string, bool> channels;  // whether its first event is a sample
  while (const lcm::LogEvent* event = log.next()) {
    if (event->channel == wanted) return std::string(wanted);
    channels.emplace(event->channel, is_sample(*event));
  }
  std::string found;
  std::string names;
  int fitting = 0;
  for (const auto& [name, fits] : channels) {
    names += (names.empty() ? "" : ", ") + name;
    if (fits) {
      found = name;
      ++fitting;
    }
  }
  if (fitting == 1) return found;
  throw bad_data(file,
                 std::string(fitting == 0 ? "has no events of type spoolwatch::sample_t"
                                          : "has samples on several channels"),
                 "channel " + std::string(wanted) +
                     "; it has: " + (names.empty() ? std::string("no complete event") : names));
}

struct Builder {
  Record record;
  std::size_t bad = 0;
  SampleColumns columns;

  explicit Builder(const std::string& name) { record.name = name; }

  void add(const sample_t& s) {
    if (s.quality >= kStaleQuality || !std::isfinite(s.y_m) || !std::isfinite(s.u_applied_V)) {
      ++bad;
      return;
    }
    const std::vector<double>& row = columns.row(s);
    for (std::size_t i = record.further.size(); i < row.size(); ++i) {
      const double missing = std::numeric_limits<double>::quiet_NaN();
      record.further.emplace_back(columns.names()[i],
                                  std::vector<double>(record.t_s.size(), missing));
    }
    record.t_s.push_back(static_cast<double>(s.tick) * s.sample_time_s);
    record.u_V.push_back(s.u_applied_V);
    record.y_m.push_back(s.y_m);
    for (std::size_t i = 0; i < row.size(); ++i) record.further[i].second.push_back(row[i]);
  }

  /// Takes what is told beside the samples of `channel`; throws where it is of another type.
  void note(const lcm::LogEvent& event, const std::string& channel, const std::string& file) {
    if (!channel.ends_with(kSampleEnding)) return;
    const std::string prefix = channel.substr(0, channel.size() - kSampleEnding.size());
    if (event.channel == prefix + "_RODS") note_as<spoolwatch::rods_t>(event, file);
    if (event.channel == prefix + "_PRESSURES") note_as<spoolwatch::pressures_t>(event, file);
  }

 private:
  template <class Message>
  void note_as(const lcm::LogEvent& event, const std::string& file) {
    Message message{};
    if (!messages::decode(message, event.data, event.datalen)) {
      throw bad_data(
          file + ": event " + std::to_string(event.eventnum),
          "on " + event.channel + " is of another type",
          std::string("spoolwatch::") + Message::getTypeName() + " in this version's layout");
    }
    columns.note(message);
  }
};

}  // namespace

bool is_lcm_log(std::string_view head) noexcept { return head.starts_with(kSyncWord); }

Record read_lcm_log(const std::string& file, std::string_view wanted) {
  const std::string channel = choose_channel(file, wanted);
  EventReader log(file);
  Builder builder(file);
  Record& record = builder.record;
  sample_t first{};
  std::vector<std::int64_t> events;  // number of the event behind each row
  while (const lcm::LogEvent* event = log.next()) {
    if (event->channel != channel) {
      builder.note(*event, channel, file);
      continue;
    }
    const std::string where = file + ": event " + std::to_string(event->eventnum);
    sample_t sample{};
    if (sample.decode(event->data, 0, event->datalen) != event->datalen) {
      throw bad_data(where, "on " + channel + " is of another type",
                     "spoolwatch::sample_t in this version's layout");
    }
    if (!(sample.sample_time_s > 0.0) || !std::isfinite(sample.sample_time_s)) {
      throw bad_data(where, "has no sample time");
    }
    if (record.t_s.empty() && builder.bad == 0) first = sample;
    if (sample.sample_time_s != first.sample_time_s || sample.run_id != first.run_id) {
      throw bad_data(where, "belongs to another run than the first sample", "one run in a log");
    }
    builder.add(sample);
    if (events.size() < record.size()) events.push_back(event->eventnum);
  }
  if (record.t_s.empty()) {
    throw bad_data(file, "has no sample with a good position and command on " + channel);
  }
  const TimeGrid grid = find_grid(
      record.t_s, [&](std::size_t i) { return file + ": event " + std::to_string(events[i]); });
  if (std::abs(grid.sample_time_s - first.sample_time_s) > 1e-6 * first.sample_time_s) {
    throw bad_data(file, "has ticks that skip regularly", "consecutive ticks");
  }
  record.sample_time_s = first.sample_time_s;
  record.gaps = grid.gaps;
  if (builder.bad > 0) {
    record.notes.push_back(std::to_string(builder.bad) +
                           " samples without a good position and command left out");
  }
  if (!log.at_end()) {
    record.notes.push_back("cut off after byte " + std::to_string(log.complete()) +
                           ": the complete events are used");
  }
  return std::move(record);
}

}  // namespace config::record
