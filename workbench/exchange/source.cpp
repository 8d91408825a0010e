#include "workbench/exchange/source.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <lcm/lcm-cpp.hpp>
#include <limits>

#include "config/messages/decode.h"
#include "config/record/event_reader.h"
#include "config/record/lcm_reader.h"
#include "config/schema/error.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"
#include "spoolwatch/sample_t.hpp"

namespace workbench::exchange {
namespace {

using config::schema::bad_data;

std::int64_t type_of(const lcm::LogEvent& event) {
  std::int64_t hash = 0;
  return __int64_t_decode_array(event.data, 0, event.datalen, &hash, 1) > 0 ? hash : 0;
}

template <class Message>
bool is_of(const lcm::LogEvent& event) {
  return type_of(event) == Message::getHash();
}

/// A kind of message, and how the names of its channels end.
struct Kind {
  const char* name;
  const char* ending;
};

/// Hands the event over when it is of this type; `kind` also claims channels by their ending.
template <class Message>
bool take_as(const std::string& log, const lcm::LogEvent& event, const Kind& kind,
             const Kinds& kinds, Listener& listener) {
  const bool right = is_of<Message>(event);
  if (!right && !event.channel.ends_with(kind.ending)) return false;
  if (!kinds.contains(kind.name)) return right;
  Message message{};
  if (!config::messages::decode(message, event.data, event.datalen)) {
    throw bad_data(
        log + ": event " + std::to_string(event.eventnum),
        "on " + event.channel + " is of another type",
        std::string("spoolwatch::") + Message::getTypeName() + " in this version's layout");
  }
  listener.on(message);
  return right;
}

bool take(const std::string& log, const lcm::LogEvent& event, const Kinds& kinds,
          Listener& listener) {
  using namespace spoolwatch;
  return take_as<sample_t>(log, event, {"sample", "_SAMPLE"}, kinds, listener) ||
         take_as<rods_t>(log, event, {"rods", "_RODS"}, kinds, listener) ||
         take_as<pressures_t>(log, event, {"pressures", "_PRESSURES"}, kinds, listener) ||
         take_as<estimate_t>(log, event, {"estimate", "_ESTIMATE"}, kinds, listener) ||
         take_as<alarm_t>(log, event, {"alarm", "_ALARM"}, kinds, listener) ||
         take_as<health_t>(log, event, {"health", "_HEALTH"}, kinds, listener);
}

class TreeListener final : public Listener {
 public:
  explicit TreeListener(const std::function<void(const Message&)>& take) : take_(take) {}
  void on(const spoolwatch::sample_t& message) override { take_(to_message(message)); }
  void on(const spoolwatch::rods_t& message) override { take_(to_message(message)); }
  void on(const spoolwatch::pressures_t& message) override { take_(to_message(message)); }
  void on(const spoolwatch::estimate_t& message) override { take_(to_message(message)); }
  void on(const spoolwatch::alarm_t& message) override { take_(to_message(message)); }
  void on(const spoolwatch::health_t& message) override { take_(to_message(message)); }

 private:
  const std::function<void(const Message&)>& take_;
};

void each_row(const config::record::Record& record,
              const std::function<void(const Message&)>& take) {
  Progress progress("exporting " + record.name);
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double t_ns = std::clamp(std::round(record.t_s[i] * 1e9), 0.0, 9e18);
    Message message{
        "sample",
        "sample",
        static_cast<std::int64_t>(t_ns),
        {{"t_s", record.t_s[i]}, {"y_m", record.y_m[i]}, {"u_applied_V", record.u_V[i]}}};
    for (const auto& [name, values] : record.further) message.values[name] = values[i];
    take(message);
    progress.at(i + 1, record.size());
  }
}

}  // namespace

Progress::Progress(const std::string& doing)
    : doing_(doing), terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_ >= 0) std::cerr << "\r\033[K" << std::flush;
}

void Progress::at(std::size_t done, std::size_t of) {
  if (!terminal_ || of == 0) return;
  const long percent = std::lround(100.0 * static_cast<double>(done) / static_cast<double>(of));
  if (percent == shown_) return;
  shown_ = percent;
  std::cerr << "\r" << doing_ << ": " << percent << " %" << std::flush;
}

bool is_log(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw bad_data(file, std::string("cannot be read: ") + std::strerror(errno));
  std::string head(4, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (in.gcount() == 0) throw bad_data(file, "is empty", "a record or an LCM event log");
  return config::record::is_lcm_log(head);
}

double sample_time_s(const std::string& log) {
  config::record::EventReader events(log);
  while (const lcm::LogEvent* event = events.next()) {
    spoolwatch::sample_t sample{};
    if (is_of<spoolwatch::sample_t>(*event) &&
        config::messages::decode(sample, event->data, event->datalen)) {
      return sample.sample_time_s;
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void read_log(const std::string& log, const Kinds& kinds, Listener& listener) {
  std::error_code ignored;
  const auto bytes = std::filesystem::file_size(log, ignored);
  bool ours = false;
  config::record::EventReader events(log);
  {
    Progress progress("exporting " + log);
    while (const lcm::LogEvent* event = events.next()) {
      const bool taken = take(log, *event, kinds, listener);
      ours = ours || taken;
      progress.at(static_cast<std::size_t>(events.complete()), static_cast<std::size_t>(bytes));
    }
  }
  if (!events.at_end()) {
    std::cerr << "spoolwatch: " << log << ": cut off after byte " << events.complete()
              << ": the complete events are used\n";
  }
  if (!ours) {
    throw bad_data(log, "has no message of this project", "a log of the daemon's channels");
  }
}

void each_message(const std::string& input, const Kinds& kinds,
                  const std::function<void(const Message&)>& take) {
  if (is_log(input)) {
    TreeListener listener(take);
    read_log(input, kinds, listener);
    return;
  }
  const config::record::Record record = config::record::read_record(input);
  for (const std::string& note : record.notes) {
    std::cerr << "spoolwatch: " << input << ": " << note << '\n';
  }
  if (kinds.contains("sample")) each_row(record, take);
}

}  // namespace workbench::exchange
