#include "config/record/command_advance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "config/schema/error.h"

namespace config::record {
namespace {

/// Tolerance within which a shift counts as whole: times are stated to six digits.
constexpr double kWhole_samples = 1e-3;
/// A record's least number of samples.
constexpr std::size_t kFewest = 3;

/// Weights of u(-1) ... u(2) in the mean over [x - 1/2, x + 1/2] of the cubic through them, which
/// is its value at x and a 24th of its second derivative there; u(0) alone for x = 0.
std::array<double, 4> mean_weights(double x) {
  if (x == 0.0) return {0.0, 1.0, 0.0, 0.0};
  return {-x * (x - 1.0) * (x - 2.0) / 6.0 + (1.0 - x) / 24.0,
          (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0 + (3.0 * x - 2.0) / 24.0,
          -(x + 1.0) * x * (x - 2.0) / 2.0 + (1.0 - 3.0 * x) / 24.0,
          (x + 1.0) * x * (x - 1.0) / 6.0 + x / 24.0};
}

double without_rounding(double lead_samples) {
  const double whole = std::round(lead_samples);
  return std::abs(lead_samples - whole) < kWhole_samples ? whole : lead_samples;
}

/// Leaves out the samples at the ends of segments whose command lies outside. One that begins
/// within the interval is held.
void keep_known(Record& record, double lead_samples) {
  const double lead = without_rounding(lead_samples);
  const auto missing = static_cast<std::size_t>(lead < 0.0 ? std::ceil(-lead) : std::floor(lead));
  std::vector<std::size_t> kept;
  std::vector<std::size_t> gaps;
  for (std::size_t i = 0; i <= record.gaps.size(); ++i) {
    std::size_t begin = i == 0 ? 0 : record.gaps[i - 1];
    std::size_t end = i == record.gaps.size() ? record.size() : record.gaps[i];
    if (lead < 0.0) {
      begin += missing;
    } else {
      end -= std::min(missing, end - begin);
    }
    if (begin < end && !kept.empty()) gaps.push_back(kept.size());
    for (std::size_t k = begin; k < end; ++k) kept.push_back(k);
  }
  const auto keep = [&kept](std::vector<double>& values) {
    for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
    values.resize(kept.size());
  };
  keep(record.t_s);
  keep(record.u_V);
  keep(record.y_m);
  for (auto& [name, values] : record.further) keep(values);
  record.gaps = std::move(gaps);
}

}  // namespace

bool interpolates(double lead_samples) noexcept {
  const double lead = without_rounding(lead_samples);
  return lead != std::floor(lead);
}

void advance_command(std::span<double> u_V, double lead_samples) {
  using Index = std::ptrdiff_t;
  const double lead = without_rounding(lead_samples);
  const double whole = std::floor(lead);
  const std::array<double, 4> weights = mean_weights(lead - whole);
  const std::vector<double> logged_V(u_V.begin(), u_V.end());
  const auto last = static_cast<Index>(u_V.size()) - 1;
  const auto at = [&](Index k) {
    return logged_V[static_cast<std::size_t>(std::clamp(k, Index{0}, last))];
  };
  for (Index k = 0; k <= last; ++k) {
    const Index ahead = k + static_cast<Index>(whole);
    double value_V = 0.0;
    for (Index i = 0; i < 4; ++i)
      value_V += weights[static_cast<std::size_t>(i)] * at(ahead + i - 1);
    u_V[static_cast<std::size_t>(k)] = value_V;
  }
}

void take_command(Record& record, const ReadOptions& options) {
  if (options.flip_command) {
    for (double& u_V : record.u_V) u_V = -u_V;
    record.notes.emplace_back("the sign of the command is turned, as --flip says");
  }
  const double advance_s = options.advance_command_s;
  if (advance_s == 0.0) return;
  const double lead_samples = advance_s / record.sample_time_s;
  const double most_s = record.sample_time_s * static_cast<double>(record.size());
  if (std::abs(advance_s) < most_s) {
    for (std::size_t i = 0; i <= record.gaps.size(); ++i) {
      const std::size_t begin = i == 0 ? 0 : record.gaps[i - 1];
      const std::size_t end = i == record.gaps.size() ? record.size() : record.gaps[i];
      advance_command(std::span(record.u_V).subspan(begin, end - begin), lead_samples);
    }
    keep_known(record, lead_samples);
  }
  if (!(std::abs(advance_s) < most_s) || record.size() < kFewest) {
    throw schema::UsageError(
        fmt::format("--advance {:.6g}: leaves nothing of {}, which is {:.4g} s long; allowed: less",
                    advance_s, record.name, most_s));
  }
  record.command_is_interpolated = interpolates(lead_samples);
  record.notes.push_back(
      fmt::format("the command is taken {:.4g} ms {} than logged, as --advance says",
                  1e3 * std::abs(advance_s), advance_s > 0.0 ? "earlier" : "later"));
}

}  // namespace config::record
