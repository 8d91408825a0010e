#include "workbench/present/dynamics_plots.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "config/signals/nan.h"
#include "config/units/quantity.h"
#include "estimator/greybox/validation/speed_response.h"
#include "estimator/spectra/autocorrelation.h"
#include "workbench/present/record_section.h"

namespace workbench::present {
namespace {

namespace spectra = estimator::spectra;
namespace validation = estimator::greybox::validation;
using config::signals::kNaN;
using estimator::greybox::Dataset;

constexpr double kPerOctave = 32.0;  ///< points drawn of a spectrum
/// Frequencies that are farther apart, and no neighbours of the spectrum, are not joined.
constexpr double kGap = 1.3;
constexpr std::size_t kFewest = 8;
/// Relative error of a model's response beyond which its band says no more: a magnitude stays
/// above 0.
constexpr double kMostError = 0.45;
constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kMillimetres = 1e3;

/// Places along a rising frequency, evenly by its logarithm where there are more.
std::vector<std::size_t> spaced(const std::vector<double>& frequency_Hz,
                                const std::vector<bool>& used) {
  std::vector<std::size_t> places;
  double next_Hz = 0.0;
  for (std::size_t i = 0; i < frequency_Hz.size(); ++i) {
    if (!used[i] || frequency_Hz[i] < next_Hz) continue;
    places.push_back(i);
    next_Hz = frequency_Hz[i] * std::exp2(1.0 / kPerOctave);
  }
  return places;
}

/// x and y of a series and its band, broken where frequencies are missing.
class Curve {
 public:
  /// `step_Hz`: between neighbours of the spectrum.
  Curve(std::string name, Tone tone, double step_Hz, bool banded)
      : step_Hz_(step_Hz), banded_(banded) {
    series_.name = std::move(name);
    series_.tone = tone;
  }

  void add(double f_Hz, double y, double low, double high) {
    const bool gap = !series_.x.empty() && f_Hz > kGap * series_.x.back() &&
                     f_Hz > series_.x.back() + 1.5 * step_Hz_;
    if (gap) put(f_Hz, kNaN, kNaN, kNaN);
    put(f_Hz, y, low, high);
  }
  Series take() { return std::move(series_); }

 private:
  void put(double f_Hz, double y, double low, double high) {
    series_.x.push_back(f_Hz);
    series_.y.push_back(y);
    if (!banded_) return;
    series_.low.push_back(low);
    series_.high.push_back(high);
  }

  Series series_;
  double step_Hz_;
  bool banded_;
};

Plot over_frequency(const std::string& title, const Axis& y) {
  Plot plot;
  plot.title = title;
  plot.x = {"frequency", "Hz", true};
  plot.y = y;
  plot.width = PlotWidth::half;
  return plot;
}

/// The angle within half a turn of 0, rad.
double wrapped(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

/// Phases of the measured response along `places`, without jumps, rad.
std::vector<double> unwrapped(const spectra::FrequencyResponse& h,
                              const std::vector<std::size_t>& places) {
  std::vector<double> phase;
  for (const std::size_t i : places) {
    const double angle = std::arg(h.value[i]);
    phase.push_back(phase.empty() ? angle : phase.back() + wrapped(angle - phase.back()));
  }
  return phase;
}

/// Standard errors of a model's response by its parameters, relative; 0 where it has none.
std::vector<double> errors_of(const Dataset& record, const NamedValues& model,
                              const spectra::FrequencyResponse& its) {
  std::vector<double> errors(its.value.size(), 0.0);
  for (const std::vector<double>& values : model.deviated) {
    const spectra::FrequencyResponse other = validation::speed_response(record, values);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      errors[i] = std::hypot(errors[i], std::abs(other.value[i] - its.value[i]));
    }
  }
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double size = std::abs(its.value[i]);
    errors[i] = size > 0.0 ? std::min(errors[i] / size, kMostError) : 0.0;
  }
  return errors;
}

}  // namespace

Plot spectrum_plot(const Dataset& record, const std::vector<NamedValues>& residuals,
                   double noise_floor_m) {
  constexpr double kMicrometres = 1e6;
  Plot plot = over_frequency("Spectrum of the residual", {"residual", "µm/√Hz", true});
  for (const NamedValues& one : residuals) {
    const spectra::CrossSpectra s = validation::residual_spectrum(record, one.values);
    const double step_Hz = s.empty() ? 0.0 : s.frequency_Hz.front();
    Curve curve(one.name, one.tone, step_Hz, false);
    for (const std::size_t i :
         spaced(s.frequency_Hz, std::vector<bool>(s.frequency_Hz.size(), true))) {
      curve.add(s.frequency_Hz[i], kMicrometres * std::sqrt(s.input[i]), 0.0, 0.0);
    }
    plot.series.push_back(curve.take());
  }
  if (std::isfinite(noise_floor_m)) {
    const double white = noise_floor_m * std::sqrt(2.0 * record.sample_time_s);
    plot.lines = {{kMicrometres * white, "the noise floor, were it white,"}};
  }
  return plot;
}

Plot autocorrelation_plot(const Dataset& record, const std::vector<NamedValues>& residuals) {
  constexpr std::size_t kMostLags = 400;
  constexpr double kLongest_s = 1.0;
  const auto lags = static_cast<std::size_t>(
      std::min(kLongest_s / record.sample_time_s,
               std::min(static_cast<double>(kMostLags), static_cast<double>(record.size()) / 4.0)));
  Plot plot;
  plot.title = "Autocorrelation of the residual";
  plot.x = {"lag", "s"};
  plot.y = {"correlation", ""};
  plot.width = PlotWidth::half;
  for (std::size_t k = 0; k <= lags; ++k) {
    plot.x_values.push_back(static_cast<double>(k) * record.sample_time_s);
  }
  for (const NamedValues& one : residuals) {
    const spectra::Autocorrelation r = spectra::autocorrelation(one.values, lags);
    add_series(plot, one.name, one.tone, r.value);
    plot.lines = {{r.white_bound, "95 % of white noise, ±"}, {-r.white_bound, ""}};
  }
  return plot;
}

std::vector<Plot> response_plots(const Dataset& record, const std::vector<NamedValues>& models,
                                 double noise_floor_m) {
  const spectra::FrequencyResponse h = validation::speed_response(record, record.y_m);
  const std::vector<std::size_t> places =
      spaced(h.frequency_Hz, validation::excited(record, h, noise_floor_m));
  if (places.size() < kFewest) return {};
  Plot magnitude =
      over_frequency("Response of the speed to the command", {"magnitude", "mm/s per V", true});
  Plot phase = over_frequency("Its phase", {"phase", "deg"});
  const std::vector<double> angles = unwrapped(h, places);
  const double step_Hz = h.frequency_Hz.front();
  Curve size("measured", Tone::measured, step_Hz, true);
  Curve angle("measured", Tone::measured, step_Hz, true);
  for (std::size_t n = 0; n < places.size(); ++n) {
    const std::size_t i = places[n];
    const double most = kMillimetres * std::abs(h.value[i]);
    const double error = 2.0 * h.error_ratio[i];
    size.add(h.frequency_Hz[i], most, most * (1.0 - error), most * (1.0 + error));
    angle.add(h.frequency_Hz[i], kDegrees * angles[n], kDegrees * (angles[n] - error),
              kDegrees * (angles[n] + error));
  }
  magnitude.series.push_back(size.take());
  phase.series.push_back(angle.take());
  for (const NamedValues& model : models) {
    const spectra::FrequencyResponse its = validation::speed_response(record, model.values);
    const bool banded = !model.deviated.empty();
    const std::vector<double> errors = errors_of(record, model, its);
    Curve its_size(model.name, model.tone, step_Hz, banded);
    Curve its_angle(model.name, model.tone, step_Hz, banded);
    for (std::size_t n = 0; n < places.size(); ++n) {
      const std::size_t i = places[n];
      const double size_now = kMillimetres * std::abs(its.value[i]);
      const double error = 2.0 * errors[i];
      its_size.add(h.frequency_Hz[i], size_now, size_now * (1.0 - error), size_now * (1.0 + error));
      const double now = angles[n] + wrapped(std::arg(its.value[i]) - angles[n]);
      its_angle.add(h.frequency_Hz[i], kDegrees * now, kDegrees * (now - error),
                    kDegrees * (now + error));
    }
    magnitude.series.push_back(its_size.take());
    phase.series.push_back(its_angle.take());
    // one model's curve may lie under another's
    magnitude.series.back().dashed = phase.series.back().dashed = magnitude.series.size() > 2;
  }
  return {magnitude, phase};
}

std::string resonance_words(const spectra::Resonance& found) {
  using config::units::quantity;
  using config::units::words;
  return words(quantity("resonance_Hz", found.frequency_Hz, found.frequency_error_Hz)) +
         ", damping " + words(quantity("damping_ratio", found.damping_ratio, found.damping_error)) +
         ": the measured response rings there and the model's does not, as a second mass behind a "
         "spring does.";
}

}  // namespace workbench::present
