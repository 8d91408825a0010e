#include "workbench/exchange/source.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>

#include "config/messages/dispatch.h"
#include "config/record/log_reader.h"
#include "config/record/readers.h"
#include "config/schema/error.h"
#include "config/schema/read_file.h"

namespace workbench::exchange {
namespace {

using config::messages::MessageKind;
using config::record::LogEvent;
using config::record::LogReader;
using config::schema::bad_data;

/// Delivers the newest event where its kind is wanted; a kind also claims channels by their ending.
/// False for a message of another project.
bool take(const LogReader& log, const Kinds& kinds, config::messages::MessageHandler& handler) {
  const LogEvent& event = log.event();
  for (const MessageKind kind : config::messages::kMessageKinds) {
    const bool right = config::messages::is_of(kind, event.data.data(), event.size());
    if (!right && !event.channel.ends_with(config::messages::channel_ending(kind))) continue;
    if (kinds.contains(config::messages::to_string(kind))) log.deliver(kind, handler);
    if (right) return true;
  }
  return false;
}

class TreeHandler final : public config::messages::MessageHandler {
 public:
  explicit TreeHandler(const std::function<void(const Message&)>& take) : take_(take) {}
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
  ExportProgress progress("exporting " + record.name);
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

ExportProgress::ExportProgress(const std::string& doing)
    : doing_(doing), terminal_(::isatty(STDERR_FILENO) == 1) {}

ExportProgress::~ExportProgress() {
  if (shown_ >= 0) std::cerr << "\r\033[K" << std::flush;
}

void ExportProgress::at(std::size_t done, std::size_t of) {
  if (!terminal_ || of == 0) return;
  const long percent = std::lround(100.0 * static_cast<double>(done) / static_cast<double>(of));
  if (percent == shown_) return;
  shown_ = percent;
  std::cerr << "\r" << doing_ << ": " << percent << " %" << std::flush;
}

bool is_log(const std::string& file) {
  const config::schema::FileContent head = config::schema::read_head(file, 4);
  if (!head.wrong.empty()) throw bad_data(file, "cannot be read: " + head.wrong);
  if (head.text.empty()) throw bad_data(file, "is empty", "a record or an LCM event log");
  return config::record::is_lcm_log(head.text);
}

double sample_time_s(const std::string& log) {
  LogReader events(log);
  spoolwatch::sample_t sample{};
  while (const LogEvent* event = events.next()) {
    if (config::messages::decode(sample, event->data.data(), event->size())) {
      return sample.sample_time_s;
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void read_log(const std::string& log, const Kinds& kinds,
              config::messages::MessageHandler& handler) {
  std::error_code ignored;
  const auto bytes = std::filesystem::file_size(log, ignored);
  bool ours = false;
  LogReader events(log);
  {
    ExportProgress progress("exporting " + log);
    while (events.next() != nullptr) {
      const bool taken = take(events, kinds, handler);
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
                  const std::function<void(const Message&)>& take,
                  const config::record::ReadOptions& reading) {
  if (is_log(input)) {
    config::record::require_as_logged(reading, input);
    TreeHandler handler(take);
    read_log(input, kinds, handler);
    return;
  }
  const config::record::Record record = config::record::read_record(input, reading);
  for (const std::string& note : record.notes) {
    std::cerr << "spoolwatch: " << input << ": " << note << '\n';
  }
  if (kinds.contains("sample")) each_row(record, take);
}

}  // namespace workbench::exchange
