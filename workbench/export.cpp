// spoolwatch export: one kind of message of an LCM log as CSV.
#include "workbench/export.h"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iostream>
#include <lcm/lcm-cpp.hpp>
#include <memory>

#include "config/record/event_reader.h"
#include "config/record/record.h"
#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "workbench/command.h"
#include "workbench/listen_lines.h"

namespace workbench {
namespace {

using config::schema::bad_data;

constexpr std::string_view kSyncWord = "\xED\xA1\xDA\x01";

std::int64_t type_of(const lcm::LogEvent& event) {
  std::int64_t hash = 0;
  return __int64_t_decode_array(event.data, 0, event.datalen, &hash, 1) > 0 ? hash : 0;
}

// A row of CSV: missing numbers are empty, text is quoted where it must be.
class Row {
 public:
  Row& operator<<(double value) {
    separate();
    if (std::isnan(value)) return *this;
    char buffer[32];
    text_.append(buffer, std::to_chars(std::begin(buffer), std::end(buffer), value).ptr);
    return *this;
  }
  Row& operator<<(bool value) { return *this << (value ? 1.0 : 0.0); }
  Row& operator<<(std::string_view value) {
    separate();
    if (value.find_first_of(",\"\n\r") == std::string_view::npos) {
      text_ += value;
      return *this;
    }
    text_ += '"';
    for (const char c : value) text_ += c == '"' ? "\"\"" : std::string(1, c);
    text_ += '"';
    return *this;
  }
  [[nodiscard]] std::string end() { return std::move(text_ += '\n'); }

 private:
  void separate() {
    if (!first_) text_ += ',';
    first_ = false;
  }
  std::string text_;
  bool first_ = true;
};

constexpr const char* kEstimateHeader =
    "t_s,source,valid,name,value,std_error,low,high,condition,reason\n";
constexpr const char* kAlarmHeader =
    "t_s,source,name,severity,active,repeat,quantity,value,std_error,low,high,direction,parameter,"
    "parameter_direction,reason,guidance\n";

void append(std::string& csv, double t_s, const spoolwatch::estimate_t& estimate) {
  for (std::size_t i = 0; i < estimate.name.size(); ++i) {
    Row row;
    row << t_s << std::string_view(estimate.source) << (estimate.valid != 0)
        << std::string_view(estimate.name[i]) << estimate.value[i] << estimate.std_error[i]
        << estimate.low[i] << estimate.high[i] << estimate.condition
        << std::string_view(estimate.reason);
    csv += row.end();
  }
}

void append(std::string& csv, double t_s, const spoolwatch::alarm_t& alarm) {
  Row row;
  row << t_s << std::string_view(alarm.source) << std::string_view(alarm.name)
      << std::string_view(severity_text(alarm.severity)) << (alarm.active != 0)
      << (alarm.repeat != 0) << std::string_view(alarm.quantity) << alarm.value << alarm.std_error
      << alarm.low << alarm.high << static_cast<double>(alarm.direction)
      << std::string_view(alarm.parameter) << static_cast<double>(alarm.parameter_direction)
      << std::string_view(alarm.reason) << std::string_view(alarm.guidance);
  csv += row.end();
}

// The grid's period, from the log's first sample; NaN when it has none.
double sample_time_s(const std::string& file) {
  config::record::EventReader log(file);
  while (const lcm::LogEvent* event = log.next()) {
    spoolwatch::sample_t sample{};
    if (type_of(*event) == spoolwatch::sample_t::getHash() &&
        sample.decode(event->data, 0, event->datalen) > 0) {
      return sample.sample_time_s;
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

// Without samples the time counts from the first message.
template <class Message>
std::string messages_as_csv(const std::string& file, const char* kind, std::string csv) {
  const double period_s = sample_time_s(file);
  config::record::EventReader log(file);
  std::int64_t first_us = -1;
  bool ours = false;
  while (const lcm::LogEvent* event = log.next()) {
    const std::int64_t type = type_of(*event);
    ours = ours || type == spoolwatch::sample_t::getHash() ||
           type == spoolwatch::estimate_t::getHash() || type == spoolwatch::alarm_t::getHash() ||
           type == spoolwatch::health_t::getHash();
    const bool wanted_channel = event->channel.ends_with(kind);
    if (type != Message::getHash() && !wanted_channel) continue;
    Message message{};
    if (message.decode(event->data, 0, event->datalen) < 0) {
      throw bad_data(
          file + ": event " + std::to_string(event->eventnum),
          "on " + event->channel + " is of another type",
          std::string("spoolwatch::") + Message::getTypeName() + " in this version's layout");
    }
    if (first_us < 0) first_us = message.utc_us;
    append(csv,
           std::isnan(period_s) ? static_cast<double>(message.utc_us - first_us) * 1e-6
                                : static_cast<double>(message.tick) * period_s,
           message);
  }
  if (!log.at_end()) {
    std::cerr << "spoolwatch: " << file << ": cut off after byte " << log.complete()
              << ": the complete events are used\n";
  }
  if (!ours) {
    throw bad_data(file, "has no message of this project", "a log of the daemon's channels");
  }
  return csv;
}

void require_lcm_log(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw bad_data(file, std::string("cannot be read: ") + std::strerror(errno));
  std::string head(kSyncWord.size(), '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (in.gcount() == 0) throw bad_data(file, "is empty", "an LCM event log");
  if (head != kSyncWord) throw bad_data(file, "is no LCM event log");
}

}  // namespace

void export_log(const std::string& log, const std::string& csv, const std::string& kind) {
  require_lcm_log(log);
  if (kind == "estimate") {
    config::record::write_whole(
        csv, messages_as_csv<spoolwatch::estimate_t>(log, "_ESTIMATE", kEstimateHeader));
  } else if (kind == "alarm") {
    config::record::write_whole(csv,
                                messages_as_csv<spoolwatch::alarm_t>(log, "_ALARM", kAlarmHeader));
  } else {
    const auto record = config::record::read_record(log);
    for (const auto& note : record.notes)
      std::cerr << "spoolwatch: " << log << ": " << note << '\n';
    config::record::write_csv(record, csv);
  }
}

void add_export(CLI::App& command, int&) {
  struct Options {
    std::string log;
    std::string csv;
    std::string kind = "sample";
  };
  auto options = std::make_shared<Options>();
  command.add_option("LOG", options->log, "an LCM event log")->required();
  command.add_option("-o,--output", options->csv, "the CSV file to write")->required();
  command.add_option("--channel", options->kind, "which messages")
      ->check(CLI::IsMember({"sample", "estimate", "alarm"}))
      ->capture_default_str();
  command.callback([options] { export_log(options->log, options->csv, options->kind); });
}

}  // namespace workbench
