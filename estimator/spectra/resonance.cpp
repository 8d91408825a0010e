#include "estimator/spectra/resonance.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>

#include "estimator/linear_algebra/decompositions.h"

namespace estimator::spectra {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kPeak = 2.0;         ///< over what is beside it
constexpr double kExplained = 4.0;    ///< sum of squares without the poles over that with them
constexpr double kLightly = 0.3;      ///< damping ratio of a resonance that rings
constexpr double kLeastError = 0.02;  ///< a ratio's: the window leaks as much
constexpr int kTurns = 15;
constexpr std::size_t kFewest = 10;  ///< points about a peak
/// Neighbouring points of a spectrum with Hann windows are not independent: their noise bandwidth
/// is that many steps.
constexpr double kBandwidth = 1.5;
/// Steps of the spectrum that a resonance is wide at least.
constexpr double kWidth = 3.0;
/// The stretch about a peak that is fitted: from f / kReach to f kReach.
constexpr double kReach = 2.0;

struct Point {
  double frequency_Hz;
  Complex ratio;
  double error;  ///< the ratio's, absolute
};

std::vector<Point> ratios(const FrequencyResponse& measured, const FrequencyResponse& model,
                          const std::vector<bool>& used) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i] || !(std::abs(model.value[i]) > 0.0)) continue;
    const Complex ratio = measured.value[i] / model.value[i];
    const double error = std::hypot(measured.error_ratio[i], model.error_ratio[i], kLeastError);
    points.push_back({measured.frequency_Hz[i], ratio, std::abs(ratio) * error});
  }
  return points;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// |R| at the point over the median of |R| on the side of it where that is more.
double height(const std::vector<Point>& points, std::size_t at) {
  std::vector<double> below;
  std::vector<double> above;
  const double f = points[at].frequency_Hz;
  for (const Point& p : points) {
    const double over = p.frequency_Hz / f;
    if (over > 1.0 / (kReach * kReach) && over < 1.0 / 1.3) below.push_back(std::abs(p.ratio));
    if (over > 1.3 && over < kReach * kReach) above.push_back(std::abs(p.ratio));
  }
  // a peak at an end of what is excited may as well be a slope
  if (below.size() < 3 || above.size() < 3) return 0.0;
  return std::abs(points[at].ratio) / std::max(median(below), median(above));
}

std::vector<Point> about(const std::vector<Point>& points, double f_Hz) {
  std::vector<Point> some;
  for (const Point& p : points) {
    if (p.frequency_Hz > f_Hz / kReach && p.frequency_Hz < f_Hz * kReach) some.push_back(p);
  }
  return some;
}

/// Numerator over denominator, in s = i f / f0.
struct Rational {
  VectorXd b = VectorXd::Zero(3);
  VectorXd a = VectorXd::Zero(2);

  [[nodiscard]] Complex below(Complex s) const { return 1.0 + a[0] * s + a[1] * s * s; }
  [[nodiscard]] Complex at(Complex s) const { return (b[0] + b[1] * s + b[2] * s * s) / below(s); }
};

struct RationalFit {
  Rational r;
  double squares = 0.0;  ///< in units of the points' errors
  MatrixXd jacobian;     ///< the same residuals'; b, then a
};

void put(MatrixXd& into, Index i, Index column, Complex value) {
  into(2 * i, column) = value.real();
  into(2 * i + 1, column) = value.imag();
}

double squares_of(const std::vector<Point>& points, const Rational& r, double f0_Hz) {
  double sum = 0.0;
  for (const Point& p : points) {
    sum += std::norm((p.ratio - r.at(Complex(0.0, p.frequency_Hz / f0_Hz))) / p.error);
  }
  return sum;
}

/// `poles` 0 or 2.
RationalFit fitted(const std::vector<Point>& points, double f0_Hz, int poles) {
  const auto n = static_cast<Index>(points.size());
  RationalFit out;
  for (int turn = 0; turn < (poles == 0 ? 1 : kTurns); ++turn) {
    MatrixXd left(2 * n, 3 + poles);
    MatrixXd right(2 * n, 1);
    for (Index i = 0; i < n; ++i) {
      const Point& p = points[static_cast<std::size_t>(i)];
      const Complex s(0.0, p.frequency_Hz / f0_Hz);
      const double weight = 1.0 / (p.error * std::abs(out.r.below(s)));
      Complex power = weight;
      for (Index k = 0; k < 3; ++k, power *= s) put(left, i, k, power);
      for (Index k = 0; k < poles; ++k) {
        put(left, i, 3 + k, -p.ratio * weight * std::pow(s, static_cast<int>(k) + 1));
      }
      put(right, i, 0, weight * p.ratio);
    }
    const VectorXd x = linear_algebra::pivoted_least_squares(left, right.col(0));
    out.r.b = x.head(3);
    if (poles > 0) out.r.a = x.tail(2);
  }
  out.squares = squares_of(points, out.r, f0_Hz);
  out.jacobian.resize(2 * n, 5);
  for (Index i = 0; i < n; ++i) {
    const Point& p = points[static_cast<std::size_t>(i)];
    const Complex s(0.0, p.frequency_Hz / f0_Hz);
    const Complex part = 1.0 / (out.r.below(s) * p.error);
    const Complex value = out.r.at(s);
    for (Index k = 0; k < 3; ++k) put(out.jacobian, i, k, part * std::pow(s, static_cast<int>(k)));
    for (Index k = 0; k < 2; ++k) {
      put(out.jacobian, i, 3 + k, -value * part * std::pow(s, static_cast<int>(k) + 1));
    }
  }
  return out;
}

/// Standard errors of frequency and damping, by their slopes over a1 and a2.
void add_errors(const RationalFit& fit, double f0_Hz, Resonance& found) {
  const double a1 = fit.r.a[0];
  const double a2 = fit.r.a[1];
  const double freedom = static_cast<double>(fit.jacobian.rows()) - 5.0;
  const double scale = kBandwidth * std::max(1.0, fit.squares / freedom);
  MatrixXd slopes = MatrixXd::Zero(5, 2);
  slopes(4, 0) = -0.5 * f0_Hz / (a2 * std::sqrt(a2));
  slopes(3, 1) = 0.5 / std::sqrt(a2);
  slopes(4, 1) = -0.25 * a1 / (a2 * std::sqrt(a2));
  const MatrixXd information = fit.jacobian.transpose() * fit.jacobian;
  const MatrixXd spread = slopes.transpose() * linear_algebra::solve_symmetric(information, slopes);
  found.frequency_error_Hz = std::sqrt(scale * spread(0, 0));
  found.damping_error = std::sqrt(scale * spread(1, 1));
}

}  // namespace

std::optional<Resonance> resonance(const FrequencyResponse& measured,
                                   const FrequencyResponse& model, const std::vector<bool>& used) {
  const std::vector<Point> points = ratios(measured, model, used);
  std::size_t peak = points.size();
  double highest = kPeak;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double one = height(points, i);
    if (one <= highest) continue;
    highest = one;
    peak = i;
  }
  if (peak == points.size()) return std::nullopt;
  const double f0_Hz = points[peak].frequency_Hz;
  const std::vector<Point> near = about(points, f0_Hz);
  if (near.size() < kFewest) return std::nullopt;
  const RationalFit with = fitted(near, f0_Hz, 2);
  const RationalFit without = fitted(near, f0_Hz, 0);
  if (!(with.r.a[0] > 0.0 && with.r.a[1] > 0.0)) return std::nullopt;
  Resonance found;
  found.frequency_Hz = f0_Hz / std::sqrt(with.r.a[1]);
  found.damping_ratio = 0.5 * with.r.a[0] / std::sqrt(with.r.a[1]);
  found.peak_ratio = highest;
  add_errors(with, f0_Hz, found);
  const bool inside = found.frequency_Hz > near.front().frequency_Hz &&
                      found.frequency_Hz < near.back().frequency_Hz;
  const double step_Hz = measured.frequency_Hz.at(1) - measured.frequency_Hz.at(0);
  const bool is_line = 2.0 * found.damping_ratio * found.frequency_Hz < kWidth * step_Hz;
  if (!inside || is_line || found.damping_ratio > kLightly ||
      without.squares < kExplained * with.squares) {
    return std::nullopt;
  }
  return found;
}

}  // namespace estimator::spectra
