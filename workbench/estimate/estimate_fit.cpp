#include "workbench/estimate/estimate_fit.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "config/schema/error.h"
#include "estimator/batch.h"
#include "estimator/free_run.h"
#include "estimator/preprocess.h"
#include "estimator/recursive.h"
#include "estimator/sliding_window.h"

namespace workbench::estimate {
namespace {

using config::record::Record;
using config::schema::bad_data;

/// u and y of a record after pre-processing.
struct Data {
  std::vector<double> t_s;
  std::vector<double> u_V;
  std::vector<double> y_m;
  std::vector<std::size_t> gaps;
  double sample_time_s = 0.0;
};

/// Samples [begin, end) of Data.
struct SampleSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
  [[nodiscard]] std::size_t size() const { return end - begin; }
};

std::span<const double> part(const std::vector<double>& values, SampleSpan range) {
  return std::span(values).subspan(range.begin, range.size());
}

std::vector<std::size_t> gaps_in(const Data& data, SampleSpan range) {
  std::vector<std::size_t> out;
  for (const std::size_t gap : data.gaps) {
    if (gap > range.begin && gap < range.end) out.push_back(gap - range.begin);
  }
  return out;
}

void filter(Data& data, const EstimateOptions& options) {
  if (options.filter == "none") return;
  estimator::FilterDesign design;
  design.band = options.filter == "low"    ? estimator::Band::low_pass
                : options.filter == "high" ? estimator::Band::high_pass
                                           : estimator::Band::band_pass;
  design.low_Hz = options.filter_low_Hz;
  design.high_Hz = options.filter_high_Hz;
  design.sample_Hz = 1.0 / data.sample_time_s;
  const estimator::Filter filter(design);
  for (std::vector<double>* values : {&data.u_V, &data.y_m}) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= data.gaps.size(); ++i) {
      const std::size_t end = i < data.gaps.size() ? data.gaps[i] : values->size();
      estimator::apply_filter(filter, std::span(*values).subspan(begin, end - begin));
      begin = end;
    }
  }
}

void decimate(Data& data, int factor, const std::string& name) {
  if (factor == 1) return;
  if (!data.gaps.empty()) {
    throw bad_data(name, "has gaps, which decimation cannot cross", "--decimate 1");
  }
  data.u_V = estimator::decimate(data.u_V, factor);
  data.y_m = estimator::decimate(data.y_m, factor);
  std::vector<double> t_s;
  for (std::size_t i = 0; i < data.t_s.size(); i += static_cast<std::size_t>(factor)) {
    t_s.push_back(data.t_s[i]);
  }
  data.t_s = std::move(t_s);
  data.sample_time_s *= factor;
}

Data prepare(const Record& record, const EstimateOptions& options) {
  Data data{record.t_s, record.u_V, record.y_m, record.gaps, record.sample_time_s};
  for (double& y_m : data.y_m) y_m -= options.offset_m;
  for (std::vector<double>* values : {&data.u_V, &data.y_m}) {
    if (options.detrend == "mean") estimator::remove_mean(*values);
    if (options.detrend == "linear") estimator::remove_line(*values);
  }
  filter(data, options);
  decimate(data, options.decimation, record.name);
  return data;
}

void score(JudgedEstimate& judged, const Data& data, SampleSpan range,
           const estimator::Structure& structure) {
  const std::span coefficients(judged.estimate.value.data(),
                               static_cast<std::size_t>(structure.size()));
  std::vector<std::size_t> edges = gaps_in(data, range);
  edges.insert(edges.begin(), 0);
  edges.push_back(range.size());
  double one_step_m2 = 0.0;
  int free_samples = 0;
  int one_step_samples = 0;
  judged.cost_m2 = 0.0;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const SampleSpan stretch{range.begin + edges[i], range.begin + edges[i + 1]};
    const auto u = part(data.u_V, stretch);
    const auto y = part(data.y_m, stretch);
    const estimator::Fit free = estimator::compare(
        y, estimator::free_run(structure, coefficients, u, y), structure.history());
    const estimator::Fit one =
        estimator::summarize(estimator::one_step_errors(structure, coefficients, u, y));
    judged.cost_m2 += free.cost_m2;
    free_samples += free.samples;
    one_step_m2 += one.cost_m2;
    one_step_samples += one.samples;
  }
  if (free_samples == 0) judged.cost_m2 = std::numeric_limits<double>::quiet_NaN();
  judged.free_run_rms_m = std::sqrt(judged.cost_m2 / free_samples);
  judged.one_step_rms_m = std::sqrt(one_step_m2 / one_step_samples);
}

JudgedEstimate judged_window(const Data& data, SampleSpan range,
                             const estimator::Estimate& estimate,
                             const estimator::Structure& structure) {
  JudgedEstimate judged;
  judged.estimate = estimate;
  judged.from_s = data.t_s[range.begin];
  judged.to_s = data.t_s[range.end - 1];
  score(judged, data, range, structure);
  return judged;
}

int in_samples(double time_s, double sample_time_s) {
  return static_cast<int>(std::clamp(std::round(time_s / sample_time_s), 1.0, 1e9));
}

/// Runs `engine` over the fitted range and judges what it gives each time it is due.
template <class Engine, class Due>
std::vector<JudgedEstimate> run_windows(Engine& engine, const Data& data, SampleSpan fitted,
                                        int window, const estimator::Structure& structure,
                                        Due&& due) {
  std::vector<JudgedEstimate> windows;
  for (std::size_t i = fitted.begin; i < fitted.end; ++i) {
    if (i > fitted.begin && std::binary_search(data.gaps.begin(), data.gaps.end(), i)) {
      const double lost = std::round((data.t_s[i] - data.t_s[i - 1]) / data.sample_time_s) - 1.0;
      due.gap(engine, static_cast<long long>(lost));
    }
    if (!due.push(engine, data.u_V[i], data.y_m[i])) continue;
    const std::size_t length = std::min(static_cast<std::size_t>(window), i + 1 - fitted.begin);
    if (length < static_cast<std::size_t>(window)) continue;
    windows.push_back(judged_window(data, {i + 1 - length, i + 1}, engine.estimate(), structure));
  }
  return windows;
}

struct WindowDue {
  static bool push(estimator::SlidingWindow& e, double u_V, double y_m) { return e.push(u_V, y_m); }
  static void gap(estimator::SlidingWindow& e, long long n) { e.gap(n); }
};

struct RecursiveDue {
  int stride;
  int since = 0;
  bool push(estimator::Recursive& e, double u_V, double y_m) {
    e.push(u_V, y_m);
    if (++since < stride) return false;
    since = 0;
    return true;
  }
  static void gap(estimator::Recursive& e, long long /*n*/) { e.gap(); }
};

estimator::Recursive make_recursive(const EstimateOptions& options) {
  estimator::RecursiveConfig config;
  config.structure = options.structure;
  config.forgetting = options.forgetting;
  config.prior_variance = options.prior_variance;
  return estimator::Recursive(config);
}

}  // namespace

EstimateResult estimate_record(const Record& record, const EstimateOptions& options) {
  const Data data = prepare(record, options);
  const auto index = [&data](double share) {
    return static_cast<std::size_t>(std::round(share * static_cast<double>(data.t_s.size())));
  };
  const SampleSpan fitted{index(options.fit_from), index(options.fit_to)};
  const estimator::Structure& structure = options.structure;
  const auto needed = static_cast<std::size_t>(structure.history() + structure.size() + 1);
  const bool whole = fitted.begin == 0 && fitted.end == data.t_s.size();
  const SampleSpan scored = whole                          ? fitted
                            : fitted.end < data.t_s.size() ? SampleSpan{fitted.end, data.t_s.size()}
                                                           : SampleSpan{0, fitted.begin};
  if (std::min(fitted.size(), scored.size()) < needed) {
    throw bad_data(record.name,
                   "is too short for " + structure.text() + ": " +
                       std::to_string(std::min(fitted.size(), scored.size())) + " samples",
                   std::to_string(needed) + " or more");
  }
  const bool windowed = !std::isnan(options.window_s);
  const int window =
      windowed ? in_samples(options.window_s, data.sample_time_s) : static_cast<int>(fitted.size());
  if (static_cast<std::size_t>(window) > fitted.size()) {
    throw bad_data(record.name, "is shorter than the window",
                   std::to_string(fitted.size()) + " samples or fewer");
  }
  const int stride =
      std::isnan(options.stride_s) ? window : in_samples(options.stride_s, data.sample_time_s);

  EstimateResult result;
  estimator::Estimate& estimate = result.whole.estimate;
  if (options.method == "recursive") {
    estimator::Recursive recursion = make_recursive(options);
    result.windows =
        run_windows(recursion, data, fitted, stride, structure, RecursiveDue{stride, 0});
    estimate = recursion.estimate();
  } else {
    estimate = estimator::fit_batch(structure, part(data.u_V, fitted), part(data.y_m, fitted),
                                    gaps_in(data, fitted));
  }
  if (options.method != "recursive" && windowed) {
    const int step = options.method == "sliding" ? std::min(stride, window) : window;
    estimator::SlidingWindow sliding({structure, window, step, {}});
    result.windows = run_windows(sliding, data, fitted, window, structure, WindowDue{});
  }
  result.whole.from_s = data.t_s[fitted.begin];
  result.whole.to_s = data.t_s[fitted.end - 1];
  result.scored_from_s = data.t_s[scored.begin];
  result.scored_to_s = data.t_s[scored.end - 1];
  score(result.whole, data, scored, structure);
  return result;
}

}  // namespace workbench::estimate
