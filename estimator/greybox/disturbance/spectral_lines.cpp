#include "estimator/greybox/disturbance/spectral_lines.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <unsupported/Eigen/FFT>

#include "estimator/greybox/disturbance/predictor.h"
#include "estimator/greybox/observer_simulation.h"
#include "estimator/linear_algebra/decompositions.h"

namespace estimator::greybox::disturbance {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Numbers of peaks tried: the highest over the local median, and the highest in power.
constexpr std::size_t kSharpest = 3;
constexpr std::size_t kStrongest = 2;
/// Half width of the local median, in bins.
constexpr std::size_t kNeighbourhood = 40;
/// Turns over the record below which a line is a drift.
constexpr double kFewestTurns = 8.0;
constexpr int kHalvings = 5;  ///< halvings of a line's frequency step, half a bin at first

StateVector input_of(const Linearisation& model, LineSite site, std::size_t k) {
  if (site == LineSite::supply) return model.from_supply[k];
  StateVector b = model.transition[k].col(kDisturbance);
  b[kDisturbance] = 0.0;
  return b;
}

/// d (half the squared innovations) / d w(k).
VectorXd influence(const Linearisation& model, const Dataset& record, const InnovationGains& gains,
                   LineSite site, const VectorXd& innovations) {
  const Index samples = innovations.size();
  VectorXd result(samples);
  StateVector adjoint = StateVector::Zero();  // adjoint of z(k + 1)
  for (Index k = samples - 1; k >= 0; --k) {
    const auto row = static_cast<std::size_t>(k);
    const StateMatrix a = transition_at(model, gains, row);
    const double own = innovations[k] * gains.scale[k];
    const StateVector back = a.transpose() * adjoint;
    const double through_gain = gain_at(gains, k).dot(back);
    result[k] =
        site == LineSite::sensor ? own - through_gain : input_of(model, site, row).dot(adjoint);
    adjoint = back;
    adjoint[0] += own - through_gain;
    if (std::binary_search(record.starts.begin(), record.starts.end(), row)) adjoint.setZero();
  }
  return result;
}

std::vector<double> peaks_of(const VectorXd& series, double sample_time_s) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<double> padded(std::bit_ceil(static_cast<std::size_t>(2 * series.size())), 0.0);
  std::copy(series.data(), series.data() + series.size(), padded.begin());
  std::vector<std::complex<double>> spectrum;
  fft.fwd(spectrum, padded);
  std::vector<double> power(spectrum.size());
  std::transform(spectrum.begin(), spectrum.end(), power.begin(),
                 [](const auto& value) { return std::norm(value); });
  const double step_Hz = 1.0 / (sample_time_s * static_cast<double>(padded.size()));
  const auto first = static_cast<std::size_t>(kFewestTurns * static_cast<double>(padded.size()) /
                                              static_cast<double>(series.size()));
  struct Peak {
    std::size_t bin;
    double power, sharpness;
  };
  std::vector<Peak> peaks;
  for (std::size_t i = std::max<std::size_t>(first, 1); i + 1 < power.size(); ++i) {
    if (power[i] < power[i - 1] || power[i] < power[i + 1]) continue;
    const std::size_t from = i > kNeighbourhood ? i - kNeighbourhood : 0;
    const std::size_t to = std::min(power.size(), i + kNeighbourhood + 1);
    std::vector<double> near(power.begin() + static_cast<std::ptrdiff_t>(from),
                             power.begin() + static_cast<std::ptrdiff_t>(to));
    const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
    std::nth_element(near.begin(), middle, near.end());
    peaks.push_back({i, power[i], power[i] / std::max(*middle, 1e-300)});
  }
  std::vector<double> found;
  const auto take = [&](auto better, std::size_t most) {
    std::stable_sort(peaks.begin(), peaks.end(), better);
    for (std::size_t i = 0; i < std::min(most, peaks.size()); ++i) {
      const double frequency_Hz = static_cast<double>(peaks[i].bin) * step_Hz;
      if (std::find(found.begin(), found.end(), frequency_Hz) == found.end()) {
        found.push_back(frequency_Hz);
      }
    }
  };
  take([](const Peak& a, const Peak& b) { return a.sharpness > b.sharpness; }, kSharpest);
  take([](const Peak& a, const Peak& b) { return a.power > b.power; }, kStrongest);
  return found;
}

}  // namespace

const char* to_string(LineSite site) {
  switch (site) {
    case LineSite::force:
      return "force";
    case LineSite::supply:
      return "pressure";
    case LineSite::sensor:
      break;
  }
  return "sensor";
}

namespace {

/// Scaled innovations (samples x Count) that inputs w(t) at a site cause; zero for samples that are
/// not valid. `inputs(t)`: Count values.
template <int Count, typename Inputs>
MatrixXd response(const Linearisation& model, const Dataset& record, const InnovationGains& gains,
                  LineSite site, Inputs inputs) {
  using Row = Eigen::Matrix<double, 1, Count>;
  const auto count = static_cast<Index>(model.states.size());  // without F
  const Index corrected = gains.gain.rows() - 1;               // states that the gains correct
  MatrixXd result(static_cast<Index>(record.size()), Count);
  std::array<Row, kMostStates> z;  // states, then F at `count`
  std::array<Row, kMostStates> next;
  z.fill(Row::Zero());
  next.fill(Row::Zero());
  std::size_t segment = 0;
  for (std::size_t row = 0; row < record.size(); ++row) {
    if (segment < record.starts.size() && record.starts[segment] == row) {
      z.fill(Row::Zero());
      ++segment;
    }
    const Row w = inputs(record.t_s[row]);
    Row e = z[0];
    if (site == LineSite::sensor) e += w;
    const auto k = static_cast<Index>(row);
    const double counts = record.valid[row] != 0 ? 1.0 : 0.0;
    result.row(k) = counts * gains.scale[k] * e;
    for (Index i = 0; i < corrected; ++i) z[static_cast<std::size_t>(i)] -= gains.gain(i, k) * e;
    z[static_cast<std::size_t>(count)] -= gains.gain(corrected, k) * e;
    const StateMatrix& a = model.transition[row];
    const Row& force = z[static_cast<std::size_t>(count)];
    for (Index i = 0; i < count; ++i) {
      Row sum = a(i, kDisturbance) * (site == LineSite::force ? force + w : force);
      if (site == LineSite::supply) sum += model.from_supply[row][i] * w;
      for (Index j = 0; j < count; ++j) sum += a(i, j) * z[static_cast<std::size_t>(j)];
      next[static_cast<std::size_t>(i)] = sum;
    }
    next[static_cast<std::size_t>(count)] = gains.decay * force;
    z.swap(next);
  }
  return result;
}

}  // namespace

MatrixXd line_response(const Linearisation& model, const Dataset& record,
                       const InnovationGains& gains, const SpectralLine& line) {
  return response<2>(model, record, gains, line.site, [&](double t_s) {
    const double angle = 2.0 * std::numbers::pi * line.frequency_Hz * t_s;
    return Eigen::RowVector2d(std::sin(angle), std::cos(angle));
  });
}

VectorXd frequency_sensitivity(const Linearisation& model, const Dataset& record,
                               const InnovationGains& gains, const SpectralLine& line,
                               const Eigen::Vector2d& wave, double at_s) {
  return response<1>(model, record, gains, line.site, [&](double t_s) {
    const double angle = 2.0 * std::numbers::pi * line.frequency_Hz * t_s;
    const double slope = wave[0] * std::cos(angle) - wave[1] * std::sin(angle);
    return Eigen::Matrix<double, 1, 1>(2.0 * std::numbers::pi * (t_s - at_s) * slope);
  });
}

Eigen::Vector2d with_frequency_moved(const Eigen::Vector2d& wave, double by_Hz, double at_s) {
  const double angle = -2.0 * std::numbers::pi * by_Hz * at_s;
  return Eigen::Rotation2Dd(angle) * wave;
}

std::vector<Eigen::Vector2d> fit_waves(const Linearisation& model, const Dataset& record,
                                       const InnovationGains& gains,
                                       const std::vector<SpectralLine>& lines,
                                       const VectorXd& innovations) {
  const auto samples = static_cast<Index>(record.size());
  const auto columns = 2 * static_cast<Index>(lines.size());
  MatrixXd responses(samples, columns);
  VectorXd norms(columns);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    responses.middleCols(2 * static_cast<Index>(i), 2) =
        line_response(model, record, gains, lines[i]);
  }
  for (Index i = 0; i < columns; ++i) {
    norms[i] = std::max(responses.col(i).norm(), 1e-300);
    responses.col(i) /= norms[i];
  }
  const VectorXd found = linear_algebra::shortest_least_squares(responses, innovations).x;
  std::vector<Eigen::Vector2d> waves;
  for (Index at = 0; at < columns; at += 2) {
    waves.emplace_back(found[at] / norms[at], found[at + 1] / norms[at + 1]);
  }
  return waves;
}

LineAmplitude line_amplitude(const Linearisation& model, const Dataset& record,
                             const SpectralLine& line, const Eigen::Vector2d& wave) {
  const auto samples = static_cast<Index>(record.size());
  const PlantStart plant = start_of(model.states);
  InnovationGains weak{{"y_m", "v_mps"}, {}, 0.0, VectorXd::Ones(samples), {}, {}};
  if (plant == PlantStart::held_by_oil) weak.states.pop_back();
  weak.gain.resize(static_cast<Index>(weak.states.size()) + 1, samples);
  weak.gain.setZero();
  for (Index k = 0; k < samples; ++k) {
    const ObserverGain gain =
        record.observer_gain(static_cast<std::size_t>(k), kObserver_per_s, plant);
    weak.gain(0, k) = gain.position;
    if (plant == PlantStart::any_speed) weak.gain(1, k) = gain.speed_per_s;
  }
  const VectorXd seen = line_response(model, record, weak, line) * wave;
  // the first half holds the transient of a line that sets in with the record
  const Index settled = samples - samples / 2;
  return {wave.norm(), std::sqrt(seen.tail(settled).squaredNorm() / static_cast<double>(settled))};
}

std::vector<LineSite> sites_of(const Linearisation& model) {
  std::vector<LineSite> sites{LineSite::force, LineSite::sensor};
  if (model.supply) sites.push_back(LineSite::supply);
  return sites;
}

std::vector<SpectralLine> promising_lines(const Linearisation& model, const Dataset& record,
                                          const InnovationGains& gains,
                                          const VectorXd& innovations) {
  std::vector<SpectralLine> lines;
  for (const LineSite site : sites_of(model)) {
    const VectorXd series = influence(model, record, gains, site, innovations);
    for (const double frequency_Hz : peaks_of(series, record.sample_time_s)) {
      lines.push_back({site, frequency_Hz});
    }
  }
  return lines;
}

TunedLine tuned(SpectralLine line, double bin_Hz,
                const std::function<double(const SpectralLine&)>& gain_of) {
  TunedLine best{line, gain_of(line)};
  double step_Hz = 0.5 * bin_Hz;
  for (int i = 0; i < kHalvings; ++i) {
    for (const double sign : {-1.0, 1.0}) {
      SpectralLine moved = best.line;
      moved.frequency_Hz += sign * step_Hz;
      const double gain = gain_of(moved);
      if (!(gain > best.gain)) continue;
      best = {moved, gain};
      break;
    }
    step_Hz *= 0.5;
  }
  return best;
}

}  // namespace estimator::greybox::disturbance
