// Periodic disturbances: a pump's pulsation on the supply pressure, a periodic force, a sensor
// mount that shakes. Each leaves a spectral line in the innovations, shaped by the plant on its
// way.
//
//   w(t) = a sin(2 pi f t) + b cos(2 pi f t)
//   z(k+1) = A (I - K c') z(k) - A K m(k) + b w(k),   e(k) = c' z(k) + m(k)
//
// w enters as a force (b = A's column of F), as a supply pressure (b = b_p, whose sign turns with
// the valve's opening) or as the reading m itself. The response to any w is linear, so a and b are
// projected out of residuals; one backward pass over the innovations tells how much each sample's w
// matters, and its periodogram shows all frequencies at once.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "estimator/greybox/disturbance/linearisation.h"
#include "estimator/greybox/innovation_gains.h"

namespace estimator::greybox::disturbance {

enum class LineSite { force, supply, sensor };
/// "force", "pressure", "sensor".
[[nodiscard]] const char* to_string(LineSite site);
/// Sites that a plant has.
[[nodiscard]] std::vector<LineSite> sites_of(const Linearisation& model);

struct SpectralLine {
  LineSite site = LineSite::force;
  double frequency_Hz = 0.0;
};

/// Scaled innovations (samples x 2) that a unit sine and a unit cosine at the site cause; zero for
/// samples that are not valid. Unit: of `gains.scale` times m per N (m/s where the plant has no
/// force), per Pa, per m.
[[nodiscard]] Eigen::MatrixXd line_response(const Linearisation& model, const Dataset& record,
                                            const InnovationGains& gains, const SpectralLine& line);

/// Amplitudes of sine and cosine of the lines in the units of their sites, fitted together to
/// scaled innovations from which no line was projected out.
[[nodiscard]] std::vector<Eigen::Vector2d> fit_waves(const Linearisation& model,
                                                     const Dataset& record,
                                                     const InnovationGains& gains,
                                                     const std::vector<SpectralLine>& lines,
                                                     const Eigen::VectorXd& innovations);

/// Scaled innovations (samples) that a line with the wave causes per Hz that its frequency is
/// higher, its phase at `at_s` kept.
[[nodiscard]] Eigen::VectorXd frequency_sensitivity(const Linearisation& model,
                                                    const Dataset& record,
                                                    const InnovationGains& gains,
                                                    const SpectralLine& line,
                                                    const Eigen::Vector2d& wave, double at_s);

/// The wave of a frequency that is `by_Hz` higher, with the value and slope that it has at `at_s`.
[[nodiscard]] Eigen::Vector2d with_frequency_moved(const Eigen::Vector2d& wave, double by_Hz,
                                                   double at_s);

struct LineAmplitude {
  double amplitude = 0.0;  ///< N (m/s), Pa or m
  double rms_m = 0.0;      ///< its part of the weak observer's residual
};
[[nodiscard]] LineAmplitude line_amplitude(const Linearisation& model, const Dataset& record,
                                           const SpectralLine& line, const Eigen::Vector2d& wave);

/// The most promising lines of the innovations (samples, scaled), a few per site: the
/// highest peaks of the periodogram over its local median and the highest in power.
[[nodiscard]] std::vector<SpectralLine> promising_lines(const Linearisation& model,
                                                        const Dataset& record,
                                                        const InnovationGains& gains,
                                                        const Eigen::VectorXd& innovations);

struct TunedLine {
  SpectralLine line;
  double gain = 0.0;
};
/// The line moved by less than a bin to where it gains most, to a thirtieth of a bin.
[[nodiscard]] TunedLine tuned(SpectralLine line, double bin_Hz,
                              const std::function<double(const SpectralLine&)>& gain_of);

}  // namespace estimator::greybox::disturbance
