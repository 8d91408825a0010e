#include <charconv>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <string_view>

#include "config/record/record.h"
#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "workbench/exchange/export.h"
#include "workbench/exchange/mcap_writer.h"
#include "workbench/exchange/source.h"
#include "workbench/live/listen_lines.h"

namespace workbench::exchange {
namespace {

// A row of CSV: missing numbers are empty, text is quoted where it must be.
class CsvRow {
 public:
  CsvRow& operator<<(double value) {
    separate();
    if (std::isnan(value)) return *this;
    char buffer[32];
    text_.append(buffer, std::to_chars(std::begin(buffer), std::end(buffer), value).ptr);
    return *this;
  }
  CsvRow& operator<<(bool value) { return *this << (value ? 1.0 : 0.0); }
  CsvRow& operator<<(std::string_view value) {
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
    CsvRow row;
    row << t_s << std::string_view(estimate.source) << (estimate.valid != 0)
        << std::string_view(estimate.name[i]) << estimate.value[i] << estimate.std_error[i]
        << estimate.low[i] << estimate.high[i] << estimate.condition
        << std::string_view(estimate.reason);
    csv += row.end();
  }
}

void append(std::string& csv, double t_s, const spoolwatch::alarm_t& alarm) {
  CsvRow row;
  row << t_s << std::string_view(alarm.source) << std::string_view(alarm.name)
      << std::string_view(live::severity_text(alarm.severity)) << (alarm.active != 0)
      << (alarm.repeat != 0) << std::string_view(alarm.quantity) << alarm.value << alarm.std_error
      << alarm.low << alarm.high << static_cast<double>(alarm.direction)
      << std::string_view(alarm.parameter) << static_cast<double>(alarm.parameter_direction)
      << std::string_view(alarm.reason) << std::string_view(alarm.guidance);
  csv += row.end();
}

class CsvTable final : public config::messages::MessageHandler {
 public:
  CsvTable(double sample_time_s, const char* header)
      : sample_time_s_(sample_time_s), csv_(header) {}
  void on(const spoolwatch::estimate_t& m) override { append(csv_, time_s(m), m); }
  void on(const spoolwatch::alarm_t& m) override { append(csv_, time_s(m), m); }
  [[nodiscard]] const std::string& text() const { return csv_; }

 private:
  // Without samples the time counts from the first message.
  template <class Message>
  double time_s(const Message& message) {
    if (!std::isnan(sample_time_s_)) return static_cast<double>(message.tick) * sample_time_s_;
    const auto utc_us = static_cast<double>(message.utc_us);
    if (std::isnan(first_us_)) first_us_ = utc_us;
    return (utc_us - first_us_) * 1e-6;
  }

  double sample_time_s_;
  double first_us_ = std::numeric_limits<double>::quiet_NaN();
  std::string csv_;
};

}  // namespace

void export_csv(const std::string& input, const std::string& kind, const std::string& output,
                const config::record::ReadOptions& reading) {
  if (kind == "sample") {
    const auto record = config::record::read_record(input, reading);
    for (const auto& note : record.notes) {
      std::cerr << "spoolwatch: " << input << ": " << note << '\n';
    }
    config::record::write_csv(record, output);
    return;
  }
  if (!is_log(input)) {
    throw config::schema::bad_data(input, "is no LCM event log: it has samples alone");
  }
  CsvTable table(sample_time_s(input), kind == "alarm" ? kAlarmHeader : kEstimateHeader);
  read_log(input, {kind}, table);
  config::record::write_whole(output, table.text());
}

namespace {

constexpr std::size_t kMostTopics = 10'000;

/// The JSON schema of an object like this one; what is missing in it may be a number.
Tree schema_of(const Tree& value) {
  if (value.is_boolean()) return {{"type", "boolean"}};
  if (value.is_string()) return {{"type", "string"}};
  if (value.is_number_integer()) return {{"type", "integer"}};
  if (!value.is_object()) return {{"type", "number"}};
  Tree properties = Tree::object();
  for (const auto& [key, part] : value.items()) properties[key] = schema_of(part);
  return {{"type", "object"}, {"properties", properties}};
}

}  // namespace

std::string json_lines(const std::string& input, const Kinds& kinds,
                       const config::record::ReadOptions& reading) {
  std::string lines;
  each_message(
      input, kinds,
      [&lines](const Message& message) { lines += text_of(with_timestamp(message)) + '\n'; },
      reading);
  return lines;
}

std::string mcap_file(const std::string& input, const Kinds& kinds,
                      const config::record::ReadOptions& reading) {
  McapWriter writer("spoolwatch");
  std::map<std::string, std::uint16_t> channels;
  each_message(
      input, kinds,
      [&](const Message& message) {
        auto channel = channels.find(message.topic);
        if (channel == channels.end()) {
          if (channels.size() == kMostTopics) {
            throw config::schema::bad_data(input, "has more than 10000 sources and alarms");
          }
          const std::uint16_t number =
              writer.add_channel("/" + message.topic, "spoolwatch." + message.kind,
                                 text_of(schema_of(message.values)));
          channel = channels.emplace(message.topic, number).first;
        }
        writer.add(channel->second, message.t_ns, text_of(message.values));
      },
      reading);
  return writer.finish();
}

}  // namespace workbench::exchange
