#include "workbench/exchange/export.h"

#include <cmath>
#include <iostream>
#include <map>

#include "config/record/hdf5/hdf5_writer.h"
#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "config/signals/nan.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "workbench/exchange/mat_writer.h"
#include "workbench/live/listen_lines.h"

namespace workbench::exchange {
namespace {

using config::signals::kNaN;
using Columns = std::vector<std::pair<std::string, std::vector<double>>>;

/// Names as identifiers, each once: a second "b1" becomes "b1_2".
class MatNames {
 public:
  std::string operator()(const std::string& name) {
    const std::string first = identifier(name);
    std::string unique = first;
    for (int i = 2; !taken_.insert(unique).second; ++i) {
      const std::string suffix = "_" + std::to_string(i);
      unique = first.substr(0, 31 - suffix.size()) + suffix;
    }
    return unique;
  }

 private:
  std::set<std::string> taken_;
};

MatValue structure_of(const Columns& columns) {
  MatNames names;
  std::vector<std::string> fields;
  for (const auto& [name, values] : columns) fields.push_back(names(name));
  MatValue structure(1, fields);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    structure.set(0, fields[i], MatValue(columns[i].second));
  }
  return structure;
}

/// The estimates of one source.
struct Source {
  std::vector<double> t_s, valid, condition;
  std::map<std::string, Columns> quantities;

  void add(double t, const spoolwatch::estimate_t& estimate) {
    t_s.push_back(t);
    valid.push_back(estimate.valid != 0 ? 1.0 : 0.0);
    condition.push_back(estimate.condition);
    for (std::size_t i = 0; i < estimate.name.size(); ++i) {
      Columns& columns = quantities[estimate.name[i]];
      if (columns.empty()) columns = {{"value", {}}, {"std_error", {}}, {"low", {}}, {"high", {}}};
      const double row[] = {estimate.value[i], estimate.std_error[i], estimate.low[i],
                            estimate.high[i]};
      for (std::size_t c = 0; c < columns.size(); ++c) {
        columns[c].second.resize(t_s.size() - 1, kNaN);  // where earlier messages had none
        columns[c].second.push_back(row[c]);
      }
    }
  }

  [[nodiscard]] MatValue structure() {
    MatNames names;
    std::vector<std::string> fields;
    for (const char* name : {"t_s", "valid", "condition_number"}) fields.push_back(names(name));
    for (const auto& [name, columns] : quantities) fields.push_back(names(name));
    MatValue value(1, fields);
    value.set(0, fields[0], MatValue(t_s));
    value.set(0, fields[1], MatValue(valid));
    value.set(0, fields[2], MatValue(condition));
    std::size_t field = 3;
    for (auto& [name, columns] : quantities) {
      for (auto& [column, values] : columns) values.resize(t_s.size(), kNaN);
      value.set(0, fields[field++], structure_of(columns));
    }
    return value;
  }
};

struct TimedAlarm {
  double t_s;
  spoolwatch::alarm_t alarm;
};

MatValue structure_of(const std::vector<TimedAlarm>& alarms) {
  MatValue all(
      alarms.size(),
      {"t_s",       "source",       "name",    "severity",  "active",    "repeat",
       "latched",   "acknowledged", "shelved", "first_up",  "quantity",  "value",
       "std_error", "low",          "high",    "direction", "parameter", "parameter_direction",
       "reason",    "guidance"});
  for (std::size_t i = 0; i < alarms.size(); ++i) {
    const auto& [t_s, a] = alarms[i];
    all.set(i, "t_s", MatValue(t_s));
    all.set(i, "source", MatValue(a.source));
    all.set(i, "name", MatValue(a.name));
    all.set(i, "severity", MatValue(std::string(live::severity_text(a.severity))));
    all.set(i, "active", MatValue(a.active != 0));
    all.set(i, "repeat", MatValue(a.repeat != 0));
    all.set(i, "latched", MatValue(a.latched != 0));
    all.set(i, "acknowledged", MatValue(a.acknowledged != 0));
    all.set(i, "shelved", MatValue(a.shelved != 0));
    all.set(i, "first_up", MatValue(a.first_up != 0));
    all.set(i, "quantity", MatValue(a.quantity));
    all.set(i, "value", MatValue(a.value));
    all.set(i, "std_error", MatValue(a.std_error));
    all.set(i, "low", MatValue(a.low));
    all.set(i, "high", MatValue(a.high));
    all.set(i, "direction", MatValue(static_cast<double>(a.direction)));
    all.set(i, "parameter", MatValue(a.parameter));
    all.set(i, "parameter_direction", MatValue(static_cast<double>(a.parameter_direction)));
    all.set(i, "reason", MatValue(a.reason));
    all.set(i, "guidance", MatValue(a.guidance));
  }
  return all;
}

/// Everything of a log but its samples.
class LogCollector final : public config::messages::MessageHandler {
 public:
  explicit LogCollector(double sample_time_s) : sample_time_s_(sample_time_s) {}

  void on(const spoolwatch::estimate_t& m) override {
    sources_[m.source].add(time_s(m, m.tick), m);
  }
  void on(const spoolwatch::alarm_t& m) override { alarms_.push_back({time_s(m, m.tick), m}); }
  void on(const spoolwatch::health_t& m) override {
    const std::pair<const char*, double> row[] = {
        {"t_s", time_s(m, m.ticks)},
        {"ticks", static_cast<double>(m.ticks)},
        {"overruns", static_cast<double>(m.overruns)},
        {"skipped_periods", static_cast<double>(m.skipped_periods)},
        {"dropped_samples", static_cast<double>(m.dropped_samples)},
        {"dropped_records", static_cast<double>(m.dropped_records)},
        {"lost_records", static_cast<double>(m.lost_records)},
        {"lateness_p50_us", m.lateness_p50_us},
        {"lateness_p999_us", m.lateness_p999_us},
        {"lateness_max_us", m.lateness_max_us},
        {"active_alarms", static_cast<double>(m.active_alarms)}};
    if (health_.empty()) {
      for (const auto& [name, value] : row) health_.emplace_back(name, std::vector<double>{});
    }
    for (std::size_t i = 0; i < health_.size(); ++i) health_[i].second.push_back(row[i].second);
  }

  void write(MatWriter& writer) {
    if (!sources_.empty()) {
      MatNames names;
      std::vector<std::string> fields;
      for (const auto& [name, source] : sources_) fields.push_back(names(name));
      MatValue estimates(1, fields);
      std::size_t field = 0;
      for (auto& [name, source] : sources_) estimates.set(0, fields[field++], source.structure());
      writer.add("estimates", std::move(estimates));
    }
    if (!alarms_.empty()) writer.add("alarms", structure_of(alarms_), true);
    if (!health_.empty()) writer.add("health", structure_of(health_));
  }

 private:
  template <class Message>
  double time_s(const Message& message, std::int64_t tick) {
    if (!std::isnan(sample_time_s_)) return static_cast<double>(tick) * sample_time_s_;
    const auto utc_us = static_cast<double>(message.utc_us);
    if (std::isnan(first_us_)) first_us_ = utc_us;
    return (utc_us - first_us_) * 1e-6;
  }

  double sample_time_s_;
  double first_us_ = kNaN;
  std::map<std::string, Source> sources_;
  std::vector<TimedAlarm> alarms_;
  Columns health_;
};

void write_record(const config::record::Record& record, MatWriter& writer) {
  for (const std::string& note : record.notes) {
    std::cerr << "spoolwatch: " << record.name << ": " << note << '\n';
  }
  MatNames names;
  writer.add(names("t_s"), MatValue(record.t_s));
  writer.add(names("u_" + record.command_unit), MatValue(record.u_V));
  writer.add(names("y_" + record.position_unit), MatValue(record.y_m));
  for (const char* ours : {"estimates", "alarms", "health"}) (void)names(ours);
  for (const auto& [name, values] : record.further) writer.add(names(name), MatValue(values));
}

}  // namespace

void write_record_file(const config::record::Record& record, const std::string& file,
                       const std::string& option) {
  if (file.ends_with(".mat")) {
    MatWriter writer;
    write_record(record, writer);
    config::record::write_whole(file, writer.finish());
  } else if (file.ends_with(".h5") || file.ends_with(".hdf5")) {
    config::record::write_whole(file, config::record::hdf5::hdf5_file(record));
  } else if (file.ends_with(".csv")) {
    config::record::write_csv(record, file);
  } else {
    throw config::schema::UsageError(
        option + " " + file + ": its ending names no format; allowed: .csv, .mat, .h5, .hdf5");
  }
}

std::string mat_file(const std::string& input, const Kinds& kinds,
                     const config::record::ReadOptions& reading) {
  MatWriter writer;
  if (!is_log(input)) {
    if (kinds.contains("sample")) write_record(config::record::read_record(input, reading), writer);
    return writer.finish();
  }
  const double period_s = sample_time_s(input);
  LogCollector collector(period_s);
  Kinds others = kinds;
  others.erase("sample");
  read_log(input, others, collector);
  if (kinds.contains("sample") && !std::isnan(period_s)) {
    write_record(config::record::read_record(input, reading), writer);
  }
  collector.write(writer);
  return writer.finish();
}

}  // namespace workbench::exchange
