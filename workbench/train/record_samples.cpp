#include "workbench/train/record_samples.h"

#include <cmath>
#include <limits>

#include "config/record/sample_columns.h"

namespace workbench::train {
namespace {

using config::record::Record;
using config::signals::Sample;
using ColumnValues = const std::vector<double>*;

double at(ColumnValues column, std::size_t row) {
  return column != nullptr ? (*column)[row] : std::numeric_limits<double>::quiet_NaN();
}

void add_pressures(const Record& record, std::vector<Sample>& samples) {
  const ColumnValues supply = record.column(config::record::kSupplyPressure);
  const ColumnValues in = record.column(config::record::kPressureIn);
  const ColumnValues out = record.column(config::record::kPressureOut);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].pressures = {at(supply, i), at(in, i), at(out, i)};
  }
}

/// Several rod sensors; a reading that a record has is a good one.
void add_rods(const Record& record, std::vector<Sample>& samples) {
  std::vector<ColumnValues> rods;
  while (rods.size() < config::signals::kMaxRods) {
    const ColumnValues rod = record.column(config::record::rod_column(rods.size()));
    if (rod == nullptr) break;
    rods.push_back(rod);
  }
  const ColumnValues in_charge = record.column(config::record::kRodInCharge);
  if (rods.size() < 2 || in_charge == nullptr) return;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double number = at(in_charge, i);
    if (!(number >= 1.0 && number <= static_cast<double>(rods.size()))) continue;
    Sample& s = samples[i];
    s.rod_count = static_cast<std::uint8_t>(rods.size());
    s.rod_in_charge = static_cast<std::uint8_t>(number - 1.0);
    const bool same = i > 0 && samples[i - 1].rod_in_charge == s.rod_in_charge;
    s.rod_changed = i > 0 && !same;
    s.rod_since = same ? samples[i - 1].rod_since : s.tick;
    for (std::size_t rod = 0; rod < rods.size(); ++rod) {
      s.rod_m[rod] = at(rods[rod], i);
      if (!std::isfinite(s.rod_m[rod])) s.rod_quality[rod] = config::signals::Quality::bad;
    }
  }
}

}  // namespace

std::vector<config::signals::Sample> to_samples(const config::record::Record& record) {
  const auto at = [&record](const char* name) { return record.column(name); };
  const std::vector<double>* reference = at("reference_m");
  const std::vector<double>* requested = at("u_requested_V");
  const std::vector<double>* quality = at("quality");
  const std::vector<double>* state = at("state");
  const std::vector<double>* saturated = at("saturated");
  std::vector<config::signals::Sample> samples(record.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    config::signals::Sample& s = samples[i];
    const double periods = (record.t_s[i] - record.t_s.front()) / record.sample_time_s;
    s.tick = std::llround(periods);
    s.gap = i == 0 ? 0 : static_cast<std::int32_t>(s.tick - samples[i - 1].tick - 1);
    s.t_read_ns = std::llround(record.t_s[i] * 1e9);
    s.t_write_ns = s.t_read_ns;
    s.utc_us = std::llround(record.t_s[i] * 1e6);
    s.y_m = record.y_m[i];
    s.u_applied_V = record.u_V[i];
    s.u_requested_V = requested != nullptr ? (*requested)[i] : record.u_V[i];
    s.reference_m =
        reference != nullptr ? (*reference)[i] : std::numeric_limits<double>::quiet_NaN();
    if (quality != nullptr && (*quality)[i] >= 0.0 && (*quality)[i] <= 3.0) {
      s.quality = static_cast<config::signals::Quality>((*quality)[i]);
    }
    if (state != nullptr && (*state)[i] >= 0.0 && (*state)[i] <= 255.0) {
      s.state = static_cast<std::uint8_t>((*state)[i]);
    }
    s.saturated = saturated != nullptr && (*saturated)[i] > 0.0;
  }
  add_pressures(record, samples);
  add_rods(record, samples);
  return samples;
}

}  // namespace workbench::train
