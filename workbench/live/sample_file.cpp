#include "workbench/live/sample_file.h"

#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>

#include "config/schema/error.h"
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

SampleFile::SampleFile(std::string file)
    : file_(std::move(file)), part_(file_ + ".part"), out_(std::fopen(part_.c_str(), "we")) {
  if (out_ == nullptr) fail();
}

SampleFile::~SampleFile() {
  if (out_ != nullptr) std::fclose(out_);
}

void SampleFile::fail() const {
  throw config::schema::RunError(part_ + ": " + std::strerror(errno));
}

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
    if (std::fputs((header + "\n").c_str(), out_) < 0) fail();
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
  if (std::fwrite(row_.data(), 1, row_.size(), out_) != row_.size()) fail();
}

void SampleFile::finish() {
  bool good = std::fflush(out_) == 0 && fsync(fileno(out_)) == 0;
  good = std::fclose(out_) == 0 && good;
  out_ = nullptr;
  if (!good) fail();
  if (rows_ == 0) {
    std::remove(part_.c_str());
  } else if (std::rename(part_.c_str(), file_.c_str()) != 0) {
    fail();
  }
}

double SampleFile::duration_s() const noexcept {
  return rows_ == 0 ? 0.0 : static_cast<double>(last_tick_ - first_tick_ + 1) * sample_time_s_;
}

}  // namespace workbench::live
