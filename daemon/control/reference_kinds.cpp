#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <sstream>

#include "config/schema/error.h"
#include "config/schema/read_file.h"
#include "daemon/control/reference_kinds.h"

namespace monitor::control {
namespace {

/// A time that is a whole number of holds up to rounding belongs to the new level: a tenth of a
/// nanosecond is far above the rounding of t_s and far below any period.
constexpr double kHoldRounding_s = 1e-10;

/// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014): a stateless hash, so that any level is accessible.
std::uint64_t mix(std::uint64_t x) noexcept {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

/// Taps of primitive polynomials of degree 3 to 16 (bit n-1 = x^n), Xilinx XAPP 052.
constexpr std::array<std::uint32_t, 17> kTaps = {0,     0,      0,      0x6,    0xC,   0x14,
                                                 0x30,  0x60,   0xB8,   0x110,  0x240, 0x500,
                                                 0x829, 0x100D, 0x2015, 0x6000, 0xD008};

}  // namespace

Steps::Steps(const ReferenceConfig& config) noexcept
    : centre_m_(config.centre_m),
      amplitude_m_(config.amplitude_m),
      hold_s_(config.hold_s),
      rise_s_(config.rise_s),
      seed_(static_cast<std::uint64_t>(config.seed)) {}

double Steps::level_m(std::int64_t index) const noexcept {
  if (index < 0) return centre_m_;
  const std::uint64_t bits = mix(mix(seed_) + static_cast<std::uint64_t>(index));
  const double unit = static_cast<double>(bits >> 11U) * 0x1p-53;  // in [0, 1)
  return centre_m_ + amplitude_m_ * (2.0 * unit - 1.0);
}

double Steps::at(double t_s) const noexcept {
  const double hold = std::floor((t_s + kHoldRounding_s) / hold_s_);
  const auto index = static_cast<std::int64_t>(hold);
  const double t = t_s - hold * hold_s_;
  const double x = rise_s_ > 0.0 ? std::clamp(t / rise_s_, 0.0, 1.0) : 1.0;
  const double blend = x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
  const double before_m = level_m(index - 1);
  return before_m + blend * (level_m(index) - before_m);
}

Prbs::Prbs(const ReferenceConfig& config)
    : centre_m_(config.centre_m), amplitude_m_(config.amplitude_m), hold_s_(config.hold_s) {
  const auto n = static_cast<unsigned>(config.register_bits);
  const std::uint32_t mask = (1U << n) - 1U;
  const std::uint32_t taps = kTaps.at(n);
  std::uint32_t state = static_cast<std::uint32_t>(config.seed) & mask;
  if (state == 0) state = mask;  // a register of zeros would never change
  bits_.reserve(mask);
  for (std::uint32_t i = 0; i < mask; ++i) {
    bits_.push_back((state >> (n - 1U)) != 0U);
    const auto feedback = static_cast<std::uint32_t>(__builtin_parity(state & taps));
    state = ((state << 1U) | feedback) & mask;
  }
}

double Prbs::at(double t_s) const noexcept {
  const auto index = static_cast<std::size_t>(std::floor((t_s + kHoldRounding_s) / hold_s_));
  return centre_m_ + (bits_[index % bits_.size()] ? amplitude_m_ : -amplitude_m_);
}

namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
/// Search grid for the peak of a multisine: a hundredth of the fastest sine, over a hundred of the
/// slowest or this many points.
constexpr double kPointsPerCycle = 100.0;
constexpr double kMaxPoints = 200000.0;

}  // namespace

Sine::Sine(double centre_m, double amplitude_m, double frequency_Hz) noexcept
    : centre_m_(centre_m), amplitude_m_(amplitude_m), frequency_Hz_(frequency_Hz) {}

double Sine::at(double t_s) const noexcept {
  return centre_m_ + amplitude_m_ * std::sin(kTurn_rad * frequency_Hz_ * t_s);
}

Triangle::Triangle(double centre_m, double amplitude_m, double frequency_Hz) noexcept
    : centre_m_(centre_m), amplitude_m_(amplitude_m), frequency_Hz_(frequency_Hz) {}

double Triangle::at(double t_s) const noexcept {
  const double cycles = frequency_Hz_ * t_s + 0.25;
  const double within = cycles - std::floor(cycles);
  return centre_m_ + amplitude_m_ * (1.0 - 4.0 * std::abs(within - 0.5));
}

Multisine::Multisine(double centre_m, double amplitude_m, std::vector<double> frequencies_Hz)
    : centre_m_(centre_m), frequencies_Hz_(std::move(frequencies_Hz)) {
  const auto [slowest, fastest] =
      std::minmax_element(frequencies_Hz_.begin(), frequencies_Hz_.end());
  const double step_s = 1.0 / (kPointsPerCycle * *fastest);
  const double points = std::min(100.0 / *slowest / step_s, kMaxPoints);
  double peak = 0.0;
  for (int i = 0; i < static_cast<int>(points); ++i) {
    peak = std::max(peak, std::abs(sum(i * step_s)));
  }
  scale_m_ = amplitude_m / peak;
}

double Multisine::phase_rad(std::size_t index) const noexcept {
  const double k = static_cast<double>(index);
  return -std::numbers::pi * k * (k + 1.0) / static_cast<double>(frequencies_Hz_.size());
}

double Multisine::sum(double t_s) const noexcept {
  double total = 0.0;
  for (std::size_t i = 0; i < frequencies_Hz_.size(); ++i) {
    total += std::sin(kTurn_rad * frequencies_Hz_[i] * t_s + phase_rad(i));
  }
  return total;
}

double Multisine::at(double t_s) const noexcept { return centre_m_ + scale_m_ * sum(t_s); }

Chirp::Chirp(const ReferenceConfig& config) noexcept
    : centre_m_(config.centre_m),
      amplitude_m_(config.amplitude_m),
      start_Hz_(config.frequency_Hz),
      end_Hz_(config.frequency_end_Hz),
      sweep_s_(config.sweep_s) {}

double Chirp::at(double t_s) const noexcept {
  const double sweeps = std::floor(t_s / sweep_s_);
  const double t = t_s - sweeps * sweep_s_;
  const double cycles = sweeps * 0.5 * (start_Hz_ + end_Hz_) * sweep_s_ + start_Hz_ * t +
                        0.5 * (end_Hz_ - start_Hz_) / sweep_s_ * t * t;
  return centre_m_ + amplitude_m_ * std::sin(kTurn_rad * cycles);
}

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
  const config::schema::FileContent content =
      config::schema::read_file(file, config::schema::kMostConfigurationBytes);
  if (!content.wrong.empty()) {
    throw bad_config(file.string(), "cannot be read (" + content.wrong + ")",
                     std::string("a CSV file with ") + kHeader);
  }
  std::istringstream in(content.text);
  std::string line;
  std::getline(in, line);
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
