#include "workbench/live/sample_file.h"

#include <charconv>
#include <cmath>
#include <iterator>

#include "config/signals/quality.h"
#include "spoolwatch/sample_t.hpp"

namespace workbench::live {
namespace {

void append(std::string& text, double value) {
  if (!text.empty()) text += ',';
  if (std::isnan(value)) return;  // a missing value is an empty field
  char buffer[32];
  const auto result = std::to_chars(std::begin(buffer), std::end(buffer), value);
  text.append(std::begin(buffer), result.ptr);
}

}  // namespace

void SampleFile::add(const spoolwatch::sample_t& s) {
  if (config::signals::is_stale(s.quality) || !std::isfinite(s.y_m) ||
      !std::isfinite(s.u_applied_V)) {
    ++unusable_;
    return;
  }
  const std::vector<double>& further = columns_.row(s);
  if (rows_ == 0) {
    first_tick_ = s.tick;
    sample_time_s_ = s.sample_time_s;
    width_ = further.size();
    std::string header = "t_s,u_V,y_m";
    for (const std::string& name : columns_.names()) header += "," + name;
    out_.append(header + '\n');
  } else if (s.tick > last_tick_ + 1) {
    ++gaps_;
    missing_ += s.tick - last_tick_ - 1;
  }
  last_tick_ = s.tick;
  ++rows_;
  row_.clear();
  for (const double value : {static_cast<double>(s.tick) * s.sample_time_s, s.u_applied_V, s.y_m}) {
    append(row_, value);
  }
  for (std::size_t i = 0; i < width_; ++i) append(row_, further[i]);
  row_ += '\n';
  out_.append(row_);
}

void SampleFile::finish() {
  if (rows_ == 0) {
    out_.discard();
  } else {
    out_.finish();
  }
}

double SampleFile::duration_s() const noexcept {
  return rows_ == 0 ? 0.0 : static_cast<double>(last_tick_ - first_tick_ + 1) * sample_time_s_;
}

}  // namespace workbench::live
