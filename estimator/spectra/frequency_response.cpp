#include "estimator/spectra/frequency_response.h"

#include <cmath>

namespace estimator::spectra {
namespace {

/// Chance of a coherence that is none.
constexpr double kChance = 1e-3;

}  // namespace

FrequencyResponse frequency_response(const CrossSpectra& spectra) {
  FrequencyResponse out;
  out.frequency_Hz = spectra.frequency_Hz;
  out.averages = spectra.averages;
  out.output = spectra.output;
  for (std::size_t i = 0; i < spectra.cross.size(); ++i) {
    const double both = spectra.input[i] * spectra.output[i];
    const double coherence = both > 0.0 ? std::norm(spectra.cross[i]) / both : 0.0;
    out.value.push_back(spectra.input[i] > 0.0 ? spectra.cross[i] / spectra.input[i] : 0.0);
    out.coherence.push_back(coherence);
    out.error_ratio.push_back(
        std::sqrt(std::max(1.0 - coherence, 0.0) / (2.0 * spectra.averages * coherence)));
  }
  return out;
}

std::vector<bool> excited(const FrequencyResponse& response, double most_error) {
  // of two series that have nothing in common, P(c > x) = (1 - x)^(n - 1)
  const double least =
      response.averages > 1.0 ? 1.0 - std::pow(kChance, 1.0 / (response.averages - 1.0)) : 1.0;
  std::vector<bool> out;
  for (std::size_t i = 0; i < response.coherence.size(); ++i) {
    out.push_back(response.coherence[i] > least && response.error_ratio[i] <= most_error);
  }
  return out;
}

}  // namespace estimator::spectra
