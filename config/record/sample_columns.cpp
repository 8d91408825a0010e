#include "config/record/sample_columns.h"

#include <algorithm>
#include <limits>

#include "spoolwatch/sample_t.hpp"

namespace config::record {
namespace {

/// More than any rig has: a damaged log must not make a million columns.
constexpr std::size_t kMostRods = 16;

/// A message belongs to a sample when both name the same tick of the same run.
template <class Message>
bool tells_of(const Message& message, const spoolwatch::sample_t& sample) noexcept {
  return message.run_id == sample.run_id && message.tick == sample.tick;
}

}  // namespace

std::string rod_column(std::size_t rod) { return "rod_" + std::to_string(rod + 1) + "_m"; }

SampleColumns::SampleColumns()
    : names_{"reference_m", "u_requested_V", "quality", "state", "saturated"} {}

void SampleColumns::note(const spoolwatch::rods_t& rods) {
  rods_ = rods;
  if (rod_columns_ != 0) return;
  rod_columns_ = names_.size();
  rods_shown_ = std::min(rods.y_m.size(), kMostRods);
  names_.emplace_back(kRodInCharge);
  for (std::size_t i = 0; i < rods_shown_; ++i) names_.push_back(rod_column(i));
}

void SampleColumns::note(const spoolwatch::pressures_t& pressures) {
  pressures_ = pressures;
  if (pressure_columns_ != 0) return;
  pressure_columns_ = names_.size();
  names_.insert(names_.end(), {kSupplyPressure, kPressureIn, kPressureOut});
}

const std::vector<double>& SampleColumns::row(const spoolwatch::sample_t& s) {
  row_.assign(names_.size(), std::numeric_limits<double>::quiet_NaN());
  std::size_t column = 0;
  for (const double value : {s.reference_m, s.u_requested_V, static_cast<double>(s.quality),
                             static_cast<double>(s.state), s.saturated != 0 ? 1.0 : 0.0}) {
    row_[column++] = value;
  }
  if (rod_columns_ != 0 && tells_of(rods_, s)) {
    row_[rod_columns_] = rods_.in_charge + 1.0;
    const std::size_t rods = std::min(rods_shown_, rods_.y_m.size());
    for (std::size_t i = 0; i < rods; ++i) row_[rod_columns_ + 1 + i] = rods_.y_m[i];
  }
  if (pressure_columns_ != 0 && tells_of(pressures_, s)) {
    row_[pressure_columns_] = pressures_.supply_Pa;
    row_[pressure_columns_ + 1] = pressures_.in_Pa;
    row_[pressure_columns_ + 2] = pressures_.out_Pa;
  }
  return row_;
}

}  // namespace config::record
