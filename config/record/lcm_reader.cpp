#include "config/record/readers.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <sstream>

#include "config/messages/dispatch.h"
#include "config/record/layout.h"
#include "config/record/log_reader.h"
#include "config/record/sample_columns.h"
#include "config/record/time_grid.h"
#include "config/schema/error.h"

namespace config::record {
namespace {

using messages::MessageKind;
using schema::bad_data;
using spoolwatch::sample_t;

constexpr std::string_view kLogSignature = "\xED\xA1\xDA\x01";
constexpr std::int8_t kStaleQuality = 2;  // and 3, bad: no new reading

/// The channel to read: the one named, or the only one of the right type.
std::string choose_channel(const std::string& file, std::string_view wanted) {
  LogReader log(file);
  std::map<std::string, bool> channels;  // true: the channel's first event is a sample
  while (const LogEvent* event = log.next()) {
    if (event->channel == wanted) return std::string(wanted);
    channels.emplace(event->channel,
                     messages::is_of(MessageKind::sample, event->data.data(), event->size()));
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

class Builder final : public messages::MessageHandler {
 public:
  Builder(const LogReader& reader, const std::string& name) : log_(reader) { record.name = name; }

  void on(const sample_t& s) override {
    if (!(s.sample_time_s > 0.0) || !std::isfinite(s.sample_time_s)) {
      throw bad_data(log_.where(), "has no sample time");
    }
    if (record.t_s.empty() && bad == 0) first = s;
    if (s.sample_time_s != first.sample_time_s || s.run_id != first.run_id) {
      throw bad_data(log_.where(), "belongs to another run than the first sample",
                     "one run in a log");
    }
    if (s.quality >= kStaleQuality || !std::isfinite(s.y_m) || !std::isfinite(s.u_applied_V)) {
      ++bad;
    } else {
      add(s);
    }
  }
  void on(const spoolwatch::rods_t& rods) override { columns_.note(rods); }
  void on(const spoolwatch::pressures_t& pressures) override { columns_.note(pressures); }

  Record record;
  sample_t first{};
  std::size_t bad = 0;
  std::vector<std::int64_t> events;  ///< number of the event behind each row

 private:
  void refuse_implausible(const char* name, double value, const char* si_unit) const {
    if (std::abs(value) <= largest_plausible(si_unit)) return;
    std::ostringstream shown;
    shown << name << " is " << value;
    throw bad_data(log_.where(), shown.str(), plausible_range(si_unit));
  }

  void add(const sample_t& s) {
    refuse_implausible("y_m", s.y_m, "m");
    refuse_implausible("u_applied_V", s.u_applied_V, "V");
    const std::vector<double>& row = columns_.row(s);
    for (std::size_t i = record.further.size(); i < row.size(); ++i) {
      const double missing = std::numeric_limits<double>::quiet_NaN();
      record.further.emplace_back(columns_.names()[i],
                                  std::vector<double>(record.t_s.size(), missing));
    }
    record.t_s.push_back(static_cast<double>(s.tick) * s.sample_time_s);
    record.u_V.push_back(s.u_applied_V);
    record.y_m.push_back(s.y_m);
    for (std::size_t i = 0; i < row.size(); ++i) record.further[i].second.push_back(row[i]);
    events.push_back(log_.event().number);
  }

  const LogReader& log_;
  SampleColumns columns_;
};

}  // namespace

bool is_lcm_log(std::string_view head) noexcept { return head.starts_with(kLogSignature); }

Record read_lcm_log(const std::string& file, std::string_view wanted) {
  const std::string channel = choose_channel(file, wanted);
  const std::string_view ending = messages::channel_ending(MessageKind::sample);
  const bool prefixed = channel.ends_with(ending);
  const std::string prefix = prefixed ? channel.substr(0, channel.size() - ending.size()) : "";
  LogReader log(file);
  Builder builder(log, file);
  Record& record = builder.record;
  const sample_t& first = builder.first;
  while (const LogEvent* event = log.next()) {
    if (event->channel == channel) {
      if (event->size() != sample_t{}.getEncodedSize()) throw log.wrong_type(MessageKind::sample);
      log.deliver(MessageKind::sample, builder);
    } else if (const auto kind = messages::kind_of(event->channel, prefix);
               prefixed && (kind == MessageKind::rods || kind == MessageKind::pressures)) {
      log.deliver(*kind, builder);
    }
  }
  if (record.t_s.empty()) {
    throw bad_data(file, "has no sample with a good position and command on " + channel);
  }
  const TimeGrid grid = find_grid(record.t_s, [&](std::size_t i) {
    return file + ": event " + std::to_string(builder.events[i]);
  });
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
