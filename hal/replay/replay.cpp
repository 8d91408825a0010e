#include "hal/replay/replay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/record/sample_columns.h"
#include "config/schema/error.h"

namespace hal::replay {
namespace {

/// Inputs and their columns.
constexpr std::pair<const char*, const char*> kColumns[] = {
    {"supply_pressure", config::record::kSupplyPressure},
    {"pressure_in", config::record::kPressureIn},
    {"pressure_out", config::record::kPressureOut}};

/// Rows per period: 1 from row to row, more across a gap.
std::vector<std::int64_t> grid(const config::record::Record& record) {
  std::vector<std::int64_t> tick(record.size(), 0);
  for (std::size_t i = 1; i < tick.size(); ++i) tick[i] = 1;
  for (const std::size_t i : record.gaps) {
    tick[i] = std::llround((record.t_s[i] - record.t_s[i - 1]) / record.sample_time_s);
  }
  for (std::size_t i = 1; i < tick.size(); ++i) tick[i] += tick[i - 1];
  return tick;
}

}  // namespace

void ReplayConfig::visit(config::schema::Visitor& v) {
  v.path({"record", "CSV, MAT or LCM event log", true}, record);
  v.choice({"pace", "recorded pace, or as fast as possible"}, pace, {"recorded", "fast"});
}

RecordCursor::RecordCursor(const config::record::Record& record) : tick_(grid(record)) {}

std::size_t RecordCursor::at(const Tick& tick) noexcept {
  while (next_ < tick_.size() && tick_[next_] < tick.index) ++next_;
  return next_ == tick_.size() || tick_[next_] == tick.index ? next_ : kNone;
}

ReplaySensor::ReplaySensor(std::shared_ptr<const config::record::Record> record)
    : record_(std::move(record)),
      quality_(record_->column("quality")),
      saturated_(record_->column("saturated")),
      rows_(*record_) {}

Reading ReplaySensor::read(const Tick& tick) noexcept {
  const std::size_t row = rows_.at(tick);
  Reading reading;
  if (row == record_->size()) {
    reading.end = true;
  } else if (row != RecordCursor::kNone) {
    reading.y_m = record_->y_m[row];
    reading.command_V = record_->u_V[row];
    reading.quality = config::signals::Quality::good;
    reading.saturated = saturated_ != nullptr && (*saturated_)[row] > 0.0;
    if (quality_ != nullptr && std::isfinite((*quality_)[row])) {
      reading.quality =
          static_cast<config::signals::Quality>(std::clamp((*quality_)[row], 0.0, 3.0));
    }
  }
  return reading;
}

ReplayInput::ReplayInput(std::shared_ptr<const config::record::Record> record,
                         const std::vector<double>& column)
    : record_(std::move(record)), column_(column), rows_(*record_) {}

InputReading ReplayInput::read(const Tick& tick) noexcept {
  const std::size_t row = rows_.at(tick);
  if (row == RecordCursor::kNone || row == record_->size() || std::isnan(column_[row])) return {};
  return {column_[row], 0, config::signals::Quality::good};
}

BackendDevices ReplayBackend::open(const OpenContext& context) const {
  const std::filesystem::path file = resolve(context, config_.record);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    throw config::schema::bad_config(context.file + ": [replay] record",
                                     "is \"" + file.string() + "\", which is not a file",
                                     "a CSV file, a MAT file or an LCM event log");
  }
  const auto record =
      std::make_shared<const config::record::Record>(config::record::read_record(file));
  config::record::require_volts_and_metres(*record);
  BackendDevices devices;
  devices.sample_time_s = record->sample_time_s;
  devices.fast = config_.pace == "fast";
  devices.rods[kRodChannel] = std::make_shared<ReplaySensor>(record);
  for (const auto& [channel, name] : kColumns) {
    const std::vector<double>* column = record->column(name);
    if (column != nullptr) devices.inputs[channel] = std::make_shared<ReplayInput>(record, *column);
  }
  return devices;
}

}  // namespace hal::replay
