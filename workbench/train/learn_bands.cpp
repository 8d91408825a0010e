#include "workbench/train/learn_bands.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "estimator/fdi/learn.h"
#include "workbench/train/record_samples.h"

namespace workbench::train {
namespace {

namespace fdi = estimator::fdi;
using config::schema::bad_config;

/// One quantity's values, one for each estimate.
struct QuantitySeries {
  std::string quantity;
  std::size_t estimator = 0;
  std::string_view name;
  std::vector<double> values{};  ///< NaN where the estimate is not valid
  double error_sum = 0.0;
  std::size_t valid = 0;
};

class BandValues final : public fdi::Events {
 public:
  explicit BandValues(std::vector<QuantitySeries>& series) : series_(series) {}
  void on_estimate(const fdi::EstimateEvent& event) override {
    if (event.warming_up) return;
    for (QuantitySeries& s : series_) {
      if (s.estimator == event.estimator) add(s, event);
    }
  }
  void on_alarm(const fdi::Alarm& /*alarm*/) override {}

 private:
  static void add(QuantitySeries& s, const fdi::EstimateEvent& event) {
    s.values.push_back(std::numeric_limits<double>::quiet_NaN());
    for (const fdi::EstimatedValue& value : event) {
      if (value.name != s.name || !event.valid) continue;
      s.values.back() = value.value;
      if (std::isfinite(value.std_error)) s.error_sum += value.std_error;
      ++s.valid;
    }
  }
  std::vector<QuantitySeries>& series_;
};

std::vector<QuantitySeries> make_series(const std::vector<std::string>& quantities,
                                        const fdi::PipelineConfig& pipeline,
                                        const std::string& file) {
  std::vector<QuantitySeries> series;
  for (const std::string& quantity : quantities) {
    const fdi::QuantityName name = fdi::split_quantity(quantity);
    std::size_t number = 0;
    while (number < pipeline.estimators.size() && pipeline.estimators[number].id != name.source) {
      ++number;
    }
    if (number == pipeline.estimators.size()) {
      throw bad_config(file, "'" + quantity + "' names no estimator", "ESTIMATOR.b1");
    }
    const fdi::EstimatorConfig& estimator = pipeline.estimators[number];
    const std::vector<std::string> names =
        fdi::estimate_names(estimator::parse_structure(estimator.structure, estimator.constant));
    if (std::find(names.begin(), names.end(), name.name) == names.end()) {
      throw bad_config(file, estimator.id + " estimates no '" + std::string(name.name) + "'",
                       config::schema::joined(names));
    }
    series.push_back({quantity, number, {}});
  }
  for (QuantitySeries& s : series) s.name = fdi::split_quantity(s.quantity).name;
  return series;
}

fdi::LearnedBand learn(const QuantitySeries& series, const fdi::EstimatorConfig& estimator,
                       const std::string& source, const LearnOptions& options, double period_s) {
  if (series.valid == 0) {
    throw config::schema::bad_data(source, "gives no valid estimate of " + series.quantity);
  }
  fdi::LearnConfig config;
  config.false_alarm_time_s = options.false_alarm_time_s;
  config.window_s = estimator.window_s;
  config.interval_s = estimator.method == "batch" ? estimator.window_s : estimator.stride_s;
  config.period_s = period_s;
  config.least_margin = series.error_sum / static_cast<double>(series.valid);
  fdi::LearnedLimits limits;
  try {
    limits = fdi::learn_limits(series.values, config);
  } catch (const config::schema::Error& error) {
    throw config::schema::bad_data(source, series.quantity + ": " + error.what());
  }
  constexpr double kHysteresisShare = 0.05;  // of the band
  fdi::LearnedBand band;
  band.quantity = series.quantity;
  band.structure = estimator.structure;
  band.estimator = estimator.fingerprint();
  band.low = limits.low;
  band.high = limits.high;
  band.hysteresis = kHysteresisShare * (limits.high - limits.low);
  band.centre = limits.centre;
  band.estimates = static_cast<std::int64_t>(series.valid);
  band.block_s = limits.block_s;
  band.widening_ratio = limits.widening_ratio;
  band.enough_s = limits.enough_s;
  return band;
}

}  // namespace

std::vector<std::string> wanted_quantities(const fdi::PipelineConfig& pipeline,
                                           const std::string& file) {
  std::vector<std::string> open;
  std::vector<std::string> all;
  for (const fdi::BandConfig& band : pipeline.bands) {
    if (fdi::split_quantity(band.quantity).source == fdi::kSampleSource) continue;
    all.push_back(band.quantity);
    if (std::isinf(band.low) && std::isinf(band.high)) open.push_back(band.quantity);
  }
  std::vector<std::string> found = open.empty() ? all : open;
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  if (found.empty()) {
    throw bad_config(file, "has no [[band]] on an estimator's quantity",
                     "one, or --quantity ESTIMATOR.b1");
  }
  return found;
}

fdi::LearnedBands learn_bands(const fdi::PipelineConfig& pipeline,
                              const std::vector<std::string>& quantities,
                              std::span<const config::record::Record> records,
                              const LearnOptions& options) {
  std::vector<QuantitySeries> series = make_series(quantities, pipeline, options.config);
  fdi::PipelineConfig without_bands = pipeline;
  without_bands.bands.clear();
  fdi::LearnedBands learned;
  learned.sample_time_s = records.front().sample_time_s;
  learned.false_alarm_time_s = options.false_alarm_time_s;
  for (const config::record::Record& record : records) {
    if (std::abs(record.sample_time_s - learned.sample_time_s) > 1e-6 * learned.sample_time_s) {
      throw config::schema::bad_data(record.name,
                                     "has another sample time than " + records.front().name);
    }
    learned.source += (learned.source.empty() ? "" : ", ") + record.name;
    fdi::Pipeline estimates(without_bands, learned.sample_time_s);
    BandValues collector(series);
    for (const config::signals::Sample& sample : to_samples(record))
      estimates.process(sample, collector);
  }
  const double period_s =
      std::isnan(options.period_s)
          ? fdi::find_period_s(records.front().u_V, records.front().sample_time_s)
          : options.period_s;
  for (const QuantitySeries& s : series) {
    learned.bands.push_back(
        learn(s, pipeline.estimators[s.estimator], learned.source, options, period_s));
  }
  return learned;
}

}  // namespace workbench::train
