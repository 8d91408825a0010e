#include "estimator/greybox/command_response.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "estimator/linear_algebra/decompositions.h"

namespace estimator::greybox {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFinest_s = 2.5e-3;
constexpr std::size_t kMostSamples = 30'000;
constexpr std::size_t kLeastSamples = 200;
constexpr std::size_t kLeastWindows = 60;
constexpr std::size_t kMostLags = 64;
constexpr double kLongestShift_s = 1.0;
/// A shift is reported where it leaves that little of the command unexplained, ...
constexpr double kLeastCorrelation = 0.97;
/// ... and that share of what a passive plant without a shift leaves.
constexpr double kMuchLess = 0.3;
/// Shifts among which the smallest is taken, as in a periodic motion, differ by less than this.
constexpr double kAlike = 1.5;
/// The samplings of u and y are half a period apart, and logs of thinned samples up to two.
constexpr Index kLeastLead = 2;
/// Valves and transducers delay as well.
constexpr Index kLeastDelay = 5;
constexpr double kLeastDelay_s = 0.05;

struct CommandSamples {
  double sample_time_s = 0.0;
  VectorXd u, y;
};

/// The longest segment, thinned by means to kFinest_s.
CommandSamples longest_segment(double sample_time_s, const std::vector<double>& u_V,
                               const std::vector<double>& y_m,
                               const std::vector<std::size_t>& starts) {
  std::size_t from = 0;
  std::size_t to = 0;
  std::size_t begin = 0;
  const auto close = [&](std::size_t end) {
    if (end - begin > to - from) {
      from = begin;
      to = end;
    }
    begin = end;
  };
  for (const std::size_t start : starts) close(start);
  close(u_V.size());
  const auto each = std::max<std::size_t>(1, static_cast<std::size_t>(kFinest_s / sample_time_s));
  const std::size_t count = std::min((to - from) / each, kMostSamples);
  CommandSamples out;
  out.sample_time_s = sample_time_s * static_cast<double>(each);
  out.u = VectorXd::Zero(static_cast<Index>(count));
  out.y = out.u;
  for (std::size_t k = 0; k < count * each; ++k) {
    out.u[static_cast<Index>(k / each)] += u_V[from + k] / static_cast<double>(each);
    out.y[static_cast<Index>(k / each)] += y_m[from + k] / static_cast<double>(each);
  }
  return out;
}

VectorXd moving_mean(const VectorXd& x, Index width) {
  VectorXd out(x.size() - width + 1);
  double sum = x.head(width).sum();
  out[0] = sum;
  for (Index k = 1; k < out.size(); ++k) {
    sum += x[k + width - 1] - x[k - 1];
    out[k] = sum;
  }
  return out / static_cast<double>(width);
}

/// Command, position and speed (per sample), smoothed over a number of samples.
struct Smoothed {
  VectorXd u, y, v;

  Smoothed(const CommandSamples& samples, Index width) {
    const auto smooth = [width](const VectorXd& x) {
      return moving_mean(moving_mean(x, width), width);
    };
    y = smooth(samples.y);
    v = y.tail(y.size() - 1) - y.head(y.size() - 1);
    u = smooth(samples.u).head(v.size());
  }
};

double correlation(const VectorXd& a, const VectorXd& b) {
  const VectorXd da = a.array() - a.mean();
  const VectorXd db = b.array() - b.mean();
  const double scale = std::sqrt(da.squaredNorm() * db.squaredNorm());
  return scale > 0.0 ? da.dot(db) / scale : 0.0;
}

/// Share of the command's square that no passive plant explains: the best of the least squares in
/// which all coefficients come out positive.
double left_by_passive_plant(const Smoothed& s, double sign) {
  const Index n = s.v.size() - 2;
  MatrixXd motion(n, 4);
  motion.col(0) = s.v.segment(1, n);
  motion.col(1) = 0.5 * (s.v.tail(n) - s.v.head(n));
  motion.col(2) = s.y.segment(1, n);
  motion.col(3) = motion.col(0).cwiseSign();
  VectorXd u = sign * s.u.segment(1, n);
  u.array() -= u.mean();
  const double all = u.squaredNorm();
  double least = 1.0;
  for (unsigned chosen = 1; chosen < 16; ++chosen) {
    MatrixXd used(n, 0);
    for (unsigned i = 0; i < 4; ++i) {
      if ((chosen >> i & 1U) == 0) continue;
      used.conservativeResize(n, used.cols() + 1);
      const VectorXd column = motion.col(static_cast<Index>(i));
      const double scale = std::max(column.norm(), 1e-300);
      used.col(used.cols() - 1) = (column.array() - column.mean()) / scale;
    }
    const VectorXd coefficients = linear_algebra::pivoted_least_squares(used, u);
    if ((coefficients.array() < 0.0).any()) continue;
    least = std::min(least, (u - used * coefficients).squaredNorm() / all);
  }
  return least;
}

/// c(L) over a fixed stretch of the speed, for -most <= L <= most.
std::vector<double> correlations(const Smoothed& s, Index most) {
  std::vector<double> all;
  const Index n = s.v.size() - 2 * most;
  const VectorXd v = s.v.segment(most, n).array() - s.v.segment(most, n).mean();
  for (Index lag = -most; lag <= most; ++lag) {
    all.push_back(correlation(v, s.u.segment(most - lag, n)));
  }
  return all;
}

/// Calls visit(smoothed, width) for each width that leaves enough of the samples.
template <class Visit>
void at_each_width(const CommandSamples& samples, const Visit& visit) {
  const auto count = static_cast<std::size_t>(samples.u.size());
  for (std::size_t w = 1; w <= kMostLags && count / w >= kLeastWindows; w *= 2) {
    visit(Smoothed(samples, static_cast<Index>(w)), static_cast<Index>(w));
  }
}

/// c(0) with the two columns exchanged.
double exchanged_correlation(const CommandSamples& samples) {
  double greatest = 0.0;
  at_each_width({samples.sample_time_s, samples.y, samples.u}, [&](const Smoothed& s, Index) {
    const double found = correlation(s.v, s.u);
    if (std::abs(found) > std::abs(greatest)) greatest = found;
  });
  return greatest;
}

}  // namespace

CommandResponse command_response(double sample_time_s, const std::vector<double>& u_V,
                                 const std::vector<double>& y_m,
                                 const std::vector<std::size_t>& starts) {
  CommandResponse response;
  const CommandSamples samples = longest_segment(sample_time_s, u_V, y_m, starts);
  const auto count = static_cast<std::size_t>(samples.u.size());
  if (count < kLeastSamples) return response;
  response.exchanged = exchanged_correlation(samples);
  const auto most = std::min(static_cast<Index>(kLongestShift_s / samples.sample_time_s),
                             static_cast<Index>(count / 10));
  double best = 0.0;
  Index width = 1;
  std::vector<double> c;
  at_each_width(samples, [&](const Smoothed& smoothed, Index w) {
    const std::vector<double> found = correlations(smoothed, most);
    const double at_once = found[static_cast<std::size_t>(most)];
    if (std::abs(at_once) > std::abs(response.correlation)) response.correlation = at_once;
    for (const double value : found) {
      if (std::abs(value) <= std::abs(best)) continue;
      best = value;
      width = w;
      c = found;
    }
  });
  if (std::abs(best) < kLeastCorrelation) return response;
  const auto left = [&c](std::size_t i) { return 1.0 - c[i] * c[i]; };
  std::size_t at = 0;
  const auto distance = [most](std::size_t i) { return std::abs(static_cast<Index>(i) - most); };
  bool found = false;
  for (std::size_t i = 1; i + 1 < c.size(); ++i) {
    const bool peak = left(i) <= left(i - 1) && left(i) <= left(i + 1);
    if (!peak || left(i) > kAlike * (1.0 - best * best) + 1e-6) continue;
    if (found && distance(i) >= distance(at)) continue;
    at = i;
    found = true;
  }
  if (!found) return response;
  const Index lag = static_cast<Index>(at) - most;
  const double delay_s = samples.sample_time_s * static_cast<double>(lag);
  const bool enough = lag <= -kLeastLead || (lag >= kLeastDelay && delay_s >= kLeastDelay_s);
  const double sign = c[at] < 0.0 ? -1.0 : 1.0;
  if (enough && left(at) < kMuchLess * left_by_passive_plant(Smoothed(samples, width), sign)) {
    response.delay_s = delay_s;
  }
  return response;
}

}  // namespace estimator::greybox
