#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "config/schema/error.h"
#include "daemon/control/reference_kinds.h"

namespace monitor::control {
namespace {

constexpr const char* kHeader = "t_s,reference_m";

/// Reads "number,number" and nothing else.
bool parse_row(const std::string& line, double& t_s, double& r_m) noexcept {
  const char* end = line.data() + line.size();
  const auto first = std::from_chars(line.data(), end, t_s);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != ',') return false;
  const auto second = std::from_chars(first.ptr + 1, end, r_m);
  return second.ec == std::errc() && second.ptr == end && std::isfinite(t_s) && std::isfinite(r_m);
}

}  // namespace

FileReference::FileReference(const std::filesystem::path& file) {
  using config::schema::bad_config;
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line)) {
    throw bad_config(file.string(), "cannot be read", std::string("a CSV file with ") + kHeader);
  }
  if (!line.empty() && line.back() == '\r') line.pop_back();
  if (line != kHeader) throw bad_config(file.string() + ":1", "is \"" + line + "\"", kHeader);
  for (int number = 2; std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    double t_s = 0.0;
    double r_m = 0.0;
    if (!parse_row(line, t_s, r_m) || (!t_s_.empty() && t_s <= t_s_.back())) {
      throw bad_config(file.string() + ":" + std::to_string(number), "is \"" + line + "\"",
                       "two finite numbers, times increasing");
    }
    t_s_.push_back(t_s);
    r_m_.push_back(r_m);
  }
  if (t_s_.empty()) throw bad_config(file.string(), "has no rows", "one row at least");
}

double FileReference::at(double t_s) const noexcept {
  const auto after = std::upper_bound(t_s_.begin(), t_s_.end(), t_s);
  if (after == t_s_.begin()) return r_m_.front();
  if (after == t_s_.end()) return r_m_.back();
  const auto i = static_cast<std::size_t>(after - t_s_.begin());
  const double fraction = (t_s - t_s_[i - 1]) / (t_s_[i] - t_s_[i - 1]);
  return r_m_[i - 1] + fraction * (r_m_[i] - r_m_[i - 1]);
}

}  // namespace monitor::control
