#include "estimator/greybox/validation/speed_response.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimator/greybox/kinematics.h"

namespace estimator::greybox::validation {
namespace {

/// Stretches of samples that count, within the segments.
template <class F>
std::vector<SampleRange> stretches(const Dataset& record, F&& counts) {
  std::vector<SampleRange> all;
  for (const SampleRange& segment : segments(record)) {
    std::size_t begin = segment.begin;
    for (std::size_t k = segment.begin; k <= segment.end; ++k) {
      if (k < segment.end && counts(k)) continue;
      if (k > begin) all.push_back({begin, k});
      begin = k + 1;
    }
  }
  return all;
}

std::size_t longest(const std::vector<SampleRange>& ranges) {
  std::size_t samples = 0;
  for (const SampleRange& r : ranges) samples = std::max(samples, r.end - r.begin);
  return samples;
}

}  // namespace

spectra::FrequencyResponse speed_response(const Dataset& record, const std::vector<double>& y_m) {
  std::vector<double> speed_mps(y_m.size(), 0.0);
  for (std::size_t k = 0; k + 1 < y_m.size(); ++k) {
    speed_mps[k] = (y_m[k + 1] - y_m[k]) / record.sample_time_s;
  }
  const std::vector<SampleRange> ranges =
      stretches(record, [&](std::size_t k) { return record.valid[k] != 0; });
  std::vector<spectra::Piece> pieces;
  for (const SampleRange& r : ranges) {
    const std::size_t count = r.end - r.begin - 1;  // the last speed needs the next sample
    pieces.push_back({std::span(record.u_V).subspan(r.begin, count),
                      std::span(speed_mps).subspan(r.begin, count)});
  }
  return spectra::frequency_response(spectra::cross_spectra(
      pieces, record.sample_time_s, spectra::window_for(longest(ranges), record.sample_time_s)));
}

std::optional<spectra::Resonance> missing_resonance(const Dataset& record,
                                                    const std::vector<double>& free_error_m,
                                                    double noise_floor_m) {
  const spectra::FrequencyResponse measured = speed_response(record, record.y_m);
  std::vector<double> modelled_m = record.y_m;
  for (std::size_t k = 0; k < modelled_m.size(); ++k) modelled_m[k] -= free_error_m[k];
  const spectra::FrequencyResponse model = speed_response(record, modelled_m);
  return spectra::resonance(measured, model, excited(record, measured, noise_floor_m));
}

std::vector<bool> excited(const Dataset& record, const spectra::FrequencyResponse& response,
                          double noise_floor_m) {
  std::vector<bool> used = spectra::excited(response, kExcitedError);
  const double step_s = record.sample_time_s;
  for (std::size_t i = 0; i < used.size(); ++i) {
    // white noise of the position, as a difference of two samples over their distance
    const double slope =
        2.0 * std::sin(std::numbers::pi * response.frequency_Hz[i] * step_s) / step_s;
    const double noise = 2.0 * step_s * std::pow(noise_floor_m * slope, 2);
    used[i] = used[i] && !(response.output[i] < kAboveNoise * noise);
  }
  return used;
}

spectra::CrossSpectra residual_spectrum(const Dataset& record,
                                        const std::vector<double>& residual_m) {
  const std::vector<SampleRange> ranges =
      stretches(record, [&](std::size_t k) { return std::isfinite(residual_m[k]); });
  std::vector<spectra::Piece> pieces;
  for (const SampleRange& r : ranges) {
    const std::span<const double> part = std::span(residual_m).subspan(r.begin, r.end - r.begin);
    pieces.push_back({part, part});
  }
  return spectra::cross_spectra(pieces, record.sample_time_s,
                                spectra::window_for(longest(ranges), record.sample_time_s));
}

}  // namespace estimator::greybox::validation
