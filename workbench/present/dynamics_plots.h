// Plots of a record and its models in the frequency domain, and of what a residual still knows of
// its past, as the reports of compare and diagnose share them.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/dataset.h"
#include "estimator/spectra/resonance.h"
#include "workbench/present/report.h"

namespace workbench::present {

/// Values of each sample of a record: a residual in m (NaN: does not count), or a position.
struct NamedValues {
  std::string name;
  Tone tone = Tone::model;
  std::vector<double> values;
  /// The same a standard deviation away along each direction of the parameters' uncertainty.
  std::vector<std::vector<double>> deviated{};
};

/// Amplitude density over frequency; the noise floor as a level where it is known.
[[nodiscard]] Plot spectrum_plot(const estimator::greybox::Dataset& record,
                                 const std::vector<NamedValues>& residuals, double noise_floor_m);

/// Over the lag, up to a second, with the bound of a white residual.
[[nodiscard]] Plot autocorrelation_plot(const estimator::greybox::Dataset& record,
                                        const std::vector<NamedValues>& residuals);

/// Magnitude and phase of the speed over the command, measured with its band of two standard
/// errors, and of each model's position, with the band of its parameters where these are deviated;
/// at the frequencies that the motion excites. Empty where it excites fewer than eight.
/// `noise_floor_m` NaN: not known.
[[nodiscard]] std::vector<Plot> response_plots(const estimator::greybox::Dataset& record,
                                               const std::vector<NamedValues>& models,
                                               double noise_floor_m);

/// "34.0 +- 0.1 Hz, damping 3.0 +- 0.2 %: the measured response rings there and the model's does
/// not, as a second mass behind a spring does."
[[nodiscard]] std::string resonance_words(const estimator::spectra::Resonance& found);

/// The meaning of the plots above, for the head of their section.
inline constexpr const char* kDynamicsMeaning =
    "Response: how the speed answers the command, by frequency, measured and simulated over the "
    "same windows (Welch, H1). The bands are two standard errors: of the measured one by the "
    "coherence, of the better model by the errors of its parameters and their correlation. Only "
    "what the "
    "motion excites is drawn: frequencies where the magnitude is known to 30 %, and the motion "
    "stands five times above the sensor's noise. The spectrum and "
    "the autocorrelation show what the residual still holds: a hill or a slow decay is something "
    "to model, a level line and a spike at lag 0 are noise.";

}  // namespace workbench::present
