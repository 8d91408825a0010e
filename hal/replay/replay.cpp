#include "hal/replay/replay.h"

#include <algorithm>
#include <cmath>

#include "config/schema/error.h"

namespace hal::replay {
namespace {

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
  v.text({"record", "CSV, MAT or LCM event log", true}, record);
  v.choice({"pace", "at the recorded pace, or as fast as possible"}, pace, {"recorded", "fast"});
}

ReplaySensor::ReplaySensor(config::record::Record record)
    : record_(std::move(record)),
      quality_(record_.column("quality")),
      saturated_(record_.column("saturated")),
      tick_(grid(record_)) {}

Reading ReplaySensor::read(const Tick& tick) noexcept {
  while (next_ < tick_.size() && tick_[next_] < tick.index) ++next_;
  Reading reading;
  if (next_ == tick_.size()) {
    reading.end = true;
  } else if (tick_[next_] == tick.index) {
    reading.y_m = record_.y_m[next_];
    reading.command_V = record_.u_V[next_];
    reading.quality = Quality::good;
    reading.saturated = saturated_ != nullptr && (*saturated_)[next_] > 0.0;
    if (quality_ != nullptr && std::isfinite((*quality_)[next_])) {
      reading.quality = static_cast<Quality>(std::clamp((*quality_)[next_], 0.0, 3.0));
    }
  }
  return reading;
}

Offer ReplayBackend::open(const Opening& opening) const {
  const std::filesystem::path file = resolve(opening, config_.record);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    throw config::schema::bad_config(opening.file + ": [replay] record",
                                     "is \"" + file.string() + "\", which is no file",
                                     "a CSV file, a MAT file or an LCM event log");
  }
  config::record::Record record = config::record::read_record(file);
  Offer offer;
  offer.sample_time_s = record.sample_time_s;
  offer.fast = config_.pace == "fast";
  offer.rods[kRodChannel] = std::make_shared<ReplaySensor>(std::move(record));
  return offer;
}

}  // namespace hal::replay
