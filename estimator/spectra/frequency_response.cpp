#include "estimator/spectra/frequency_response.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace estimator::spectra {
namespace {

/// Chance of a coherence that is none.
constexpr double kChance = 1e-3;
/// Power that the windows leak from other frequencies, over what is there, that leaves a response.
constexpr double kMostLeaked = 0.1;
/// Half width of a Hann window's main lobe, steps.
constexpr std::size_t kLobe = 3;

/// Power density that the windows' sidelobes bring from beyond their main lobe, at most:
/// a Hann window answers d steps off its frequency with up to 1 / (pi d (d^2 - 1)).
std::vector<double> leaked(const std::vector<double>& density) {
  std::vector<double> share(density.size(), 0.0);
  for (std::size_t d = kLobe; d < share.size(); ++d) {
    const auto steps = static_cast<double>(d);
    share[d] = std::pow(std::numbers::pi * steps * (steps * steps - 1.0), -2.0);
  }
  std::vector<double> out(density.size(), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (std::size_t j = 0; j < out.size(); ++j) {
      out[i] += density[j] * share[i > j ? i - j : j - i];
    }
  }
  return out;
}

}  // namespace

FrequencyResponse frequency_response(const CrossSpectra& spectra) {
  FrequencyResponse out;
  out.frequency_Hz = spectra.frequency_Hz;
  out.averages = spectra.averages;
  out.output = spectra.output;
  const std::vector<double> leak = leaked(spectra.input);
  for (std::size_t i = 0; i < spectra.cross.size(); ++i) {
    const double both = spectra.input[i] * spectra.output[i];
    const double coherence = both > 0.0 ? std::norm(spectra.cross[i]) / both : 0.0;
    out.value.push_back(spectra.input[i] > 0.0 ? spectra.cross[i] / spectra.input[i] : 0.0);
    out.coherence.push_back(coherence);
    const double error =
        std::sqrt(std::max(1.0 - coherence, 0.0) / (2.0 * spectra.averages * coherence));
    const bool is_leak = leak[i] > kMostLeaked * spectra.input[i];
    out.error_ratio.push_back(is_leak ? std::numeric_limits<double>::infinity() : error);
  }
  return out;
}

std::vector<bool> excited(const FrequencyResponse& response, double most_error) {
  // P(c > x) = (1 - x)^(n - 1) for two series that have nothing in common
  if (!(response.averages > 1.0)) return std::vector<bool>(response.coherence.size(), false);
  const double least = 1.0 - std::pow(kChance, 1.0 / (response.averages - 1.0));
  std::vector<bool> out;
  for (std::size_t i = 0; i < response.coherence.size(); ++i) {
    out.push_back(response.coherence[i] > least && response.error_ratio[i] <= most_error);
  }
  return out;
}

}  // namespace estimator::spectra
