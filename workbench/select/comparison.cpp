// Drives the comparison: prepares the record, fits every structure, scores it.
#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>

#include "config/schema/error.h"
#include "estimator/batch.h"
#include "estimator/free_run.h"
#include "estimator/residual/noise_floor.h"
#include "estimator/residual/whiteness.h"
#include "estimator/structures/recursive_prediction_error.h"
#include "workbench/diagnose/parallel.h"
#include "workbench/select/outcome.h"

namespace workbench::select {
namespace {

using config::schema::Error;
using config::schema::ExitCode;
using structures::Stretch;
using structures::Stretches;

constexpr double kKnownBefore_s = 0.25;  // measured samples before a free run
constexpr int kLeastPeriods = 3;
constexpr int kLeastPeriod = 20;  // samples
constexpr int kMostDelay = 10;
constexpr double kClear = 10.0;   // of BIC: "very strong" evidence (Kass, Raftery 1995)
constexpr double kReached = 1.5;  // of the batch fit's free run
constexpr int kWhitenessLags = 20;

/// The record as it is compared on.
struct Ground {
  std::vector<double> y_m;
  std::vector<double> u_V;
  const config::record::Record* record = nullptr;
  std::size_t split = 0;  ///< first sample held out
  int period = 0;         ///< samples
  int known = 0;          ///< samples before each free run
  Stretches fitted;
  Stretches held_out;
  Stretches whole;
};

int in_samples(double time_s, double sample_time_s) {
  return static_cast<int>(std::clamp(std::round(time_s / sample_time_s), 1.0, 1e9));
}

Ground prepare(const config::record::Record& record, const Request& request, Outcome& outcome) {
  Ground out;
  out.record = &record;
  const std::size_t n = record.size();
  out.split = static_cast<std::size_t>(request.fit_share * static_cast<double>(n));
  out.y_m = record.y_m;
  out.u_V = record.u_V;
  double mean = 0.0;
  for (std::size_t t = 0; t < out.split; ++t) mean += out.y_m[t] / static_cast<double>(out.split);
  if (request.de_mean) {
    for (double& y : out.y_m) y -= mean;
  }
  out.period = in_samples(request.period_s, record.sample_time_s);
  const int most = static_cast<int>(n - out.split) / kLeastPeriods;
  if (out.period > most) {
    out.period = most;
    outcome.notes.push_back("the record is short: periods of " +
                            std::to_string(out.period * record.sample_time_s) + " s are compared");
  }
  out.known = std::min(in_samples(kKnownBefore_s, record.sample_time_s), out.period / 2);
  if (out.period < kLeastPeriod) {
    throw config::schema::bad_data(record.name, "is too short to compare structures on",
                                   "at least 120 samples");
  }
  const auto stretches = [&](std::size_t from, std::size_t to) {
    return structures::stretches_of(out.u_V, out.y_m, record.gaps, from, to, out.period);
  };
  out.fitted = stretches(0, out.split);
  out.held_out = stretches(out.split, n);
  out.whole = stretches(0, n);
  if (out.fitted.empty() || out.held_out.empty()) {
    throw config::schema::bad_data(record.name, "has too many gaps to compare structures on",
                                   "stretches of one period, --period, in both parts");
  }
  const auto moves = [](const Stretches& data, bool input) {
    for (const Stretch& s : data) {
      const auto& x = input ? s.u_V : s.y_m;
      if (std::any_of(x.begin(), x.end(), [&](double v) { return v != x.front(); })) return true;
    }
    return false;
  };
  for (const Stretches* part : {&out.fitted, &out.held_out}) {
    const char* const which = part == &out.fitted ? "fitted" : "held-out";
    if (!moves(*part, true)) {
      throw config::schema::bad_data(record.name,
                                     std::string("u_V never changes in the ") + which + " part");
    }
    if (!moves(*part, false)) {
      throw config::schema::bad_data(record.name,
                                     std::string("y_m never changes in the ") + which + " part");
    }
  }
  return out;
}

/// One-step energy of the fitted part, from sample `known` of each stretch on: alike for all.
double criterion_energy(const Fitted& fitted, const Ground& ground, int& count) {
  double sum = 0.0;
  count = 0;
  for (const Stretch& stretch : ground.fitted) {
    const std::vector<double> e = fitted.one_step_errors(stretch);
    for (std::size_t t = static_cast<std::size_t>(ground.known); t < e.size(); ++t) {
      sum += e[t] * e[t];
      ++count;
    }
  }
  return sum;
}

int find_delay(const Ground& ground) {
  double best = std::numeric_limits<double>::infinity();
  std::vector<double> values;
  for (int k = 1; k <= kMostDelay; ++k) {
    const structures::PolynomialFit found = structures::fit_prediction_error(
        {.a = 3, .b = 1, .k = k, .constant = true}, ground.fitted, {.errors = false});
    double value = std::numeric_limits<double>::infinity();
    if (found.valid) {
      Fitted fitted;
      fitted.model = found.model;
      int count = 0;
      const double energy = criterion_energy(fitted, ground, count);
      value = count * std::log(energy / count);
    }
    values.push_back(value);
    best = std::min(best, value);
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] <= best + kClear) return static_cast<int>(i) + 1;
  }
  return 1;
}

void score_free_runs(Judged& judged, const Ground& ground) {
  double whole = 0.0;
  int whole_count = 0;
  double periods = 0.0;
  for (const Stretch& stretch : ground.held_out) {
    const auto known = static_cast<std::size_t>(ground.known);
    const std::vector<double> y = judged.fitted.free_run(stretch, ground.known);
    for (std::size_t t = known; t < y.size(); ++t) {
      whole += (stretch.y_m[t] - y[t]) * (stretch.y_m[t] - y[t]);
      ++whole_count;
    }
    const auto period = static_cast<std::size_t>(ground.period);
    for (std::size_t from = 0; from + known + period <= y.size(); from += period) {
      const Stretch one{stretch.u_V.subspan(from, known + period),
                        stretch.y_m.subspan(from, known + period)};
      const std::vector<double> run = judged.fitted.free_run(one, ground.known);
      double cost = 0.0;
      for (std::size_t t = known; t < run.size(); ++t) {
        cost += (one.y_m[t] - run[t]) * (one.y_m[t] - run[t]);
      }
      judged.period_costs_m2.push_back(cost);
      periods += cost;
    }
  }
  const auto count = static_cast<double>(judged.period_costs_m2.size());
  judged.free_run_whole_rms_m = std::sqrt(whole / whole_count);
  judged.cost_m2 = count > 0 ? periods / count : kMissing;
  judged.free_run_rms_m = std::sqrt(judged.cost_m2 / ground.period);
}

double sd_held_out(const Ground& ground) {
  double sum = 0.0, square = 0.0, count = 0.0;
  for (const Stretch& stretch : ground.held_out) {
    for (const double y : stretch.y_m) {
      sum += y;
      square += y * y;
      count += 1.0;
    }
  }
  return std::sqrt(std::max(0.0, square / count - sum * sum / (count * count)));
}

void score(Judged& judged, const Ground& ground) {
  double sum = 0.0;
  int count = 0;
  for (const Stretch& stretch : ground.held_out) {
    const std::vector<double> e = judged.fitted.one_step_errors(stretch);
    for (std::size_t t = static_cast<std::size_t>(ground.known); t < e.size(); ++t) {
      sum += e[t] * e[t];
      ++count;
    }
  }
  judged.one_step_rms_m = std::sqrt(sum / count);
  score_free_runs(judged, ground);
  const double sd = sd_held_out(ground);
  judged.fit_percent = 100.0 * (1.0 - judged.free_run_rms_m / sd);
  judged.represents = judged.free_run_rms_m < sd;

  const double energy = criterion_energy(judged.fitted, ground, count);
  const double p = judged.fitted.parameters;
  const double log_energy = count * std::log(energy / count);
  judged.aicc = log_energy + 2.0 * p + 2.0 * p * (p + 1.0) / (count - p - 1.0);
  judged.bic = log_energy + p * std::log(count);
  std::vector<double> longest;
  for (const Stretch& stretch : ground.fitted) {
    std::vector<double> e = judged.fitted.one_step_errors(stretch);
    if (e.size() > longest.size()) longest = std::move(e);
  }
  longest.erase(longest.begin(), longest.begin() + ground.known);
  judged.whiteness_p = estimator::residual::whiteness(longest, kWhitenessLags).p;
}

char letter_of(const std::string& name) { return name == "constant" ? '\0' : name.front(); }

/// Fits to single periods of the whole record.
void score_spread(Judged& judged, const Ground& ground, const std::function<bool()>& cancel) {
  const std::size_t size = judged.fitted.value.size();
  std::vector<double> sum(size, 0.0), square(size, 0.0);
  const int length = std::max(ground.period, judged.candidate.least_samples());
  for (const Stretch& stretch : ground.whole) {
    const auto period = static_cast<std::size_t>(length);
    for (std::size_t from = 0; from + period <= stretch.y_m.size(); from += period) {
      if (cancel()) return;
      const Fitted one =
          fit(judged.candidate,
              {{stretch.u_V.subspan(from, period), stretch.y_m.subspan(from, period)}},
              &judged.fitted, cancel);
      if (!one.valid) continue;
      ++judged.periods;
      for (std::size_t i = 0; i < size; ++i) {
        // About the whole fit: the squares stay small.
        const double off = one.value[i] - judged.fitted.value[i];
        sum[i] += off;
        square[i] += off * off;
      }
    }
  }
  if (judged.periods < 2) return;
  const double n = judged.periods;
  for (std::size_t i = 0; i < size; ++i) {
    judged.period_mean.push_back(judged.fitted.value[i] + sum[i] / n);
    judged.period_variance.push_back(std::max(0.0, (square[i] - sum[i] * sum[i] / n) / (n - 1.0)));
  }
  double total = 0.0;
  int counted = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const char letter = letter_of(judged.fitted.names[i]);
    if (letter == '\0') continue;  // a constant may well be 0: it has no size to compare with
    double largest = 0.0;
    for (std::size_t j = 0; j < size; ++j) {
      if (letter_of(judged.fitted.names[j]) == letter) {
        largest = std::max(largest, std::abs(judged.period_mean[j]));
      }
    }
    total += judged.period_variance[i] / (largest * largest);
    ++counted;
  }
  judged.spread = std::sqrt(total / counted);
}

void run_on_line(Judged& judged, const Ground& ground) {
  judged.on_line = on_line_form(judged.candidate, judged.fitted);
  const auto* orders = std::get_if<structures::Orders>(&judged.candidate.what);
  if (!judged.on_line.sound || orders == nullptr || orders->size() > estimator::kMaxCoefficients) {
    return;
  }
  structures::RecursivePredictionError filter({.orders = *orders});
  for (const Stretch& stretch : ground.fitted) {
    filter.gap();
    for (std::size_t t = 0; t < stretch.y_m.size(); ++t)
      filter.push(stretch.u_V[t], stretch.y_m[t]);
  }
  Judged found;
  found.fitted.model = structures::from_values(*orders, filter.value());
  score_free_runs(found, ground);
  judged.on_line.free_run_rms_m = found.free_run_rms_m;
  if (!(found.free_run_rms_m <= kReached * judged.free_run_rms_m)) {
    judged.on_line.sound = false;
    judged.on_line.why = "its recursion does not come to the batch fit on this record";
  }
}

void test_closed_loop(Judged& judged, const Ground& ground) {
  const structures::Orders* const arx = judged.candidate.arx();
  if (arx == nullptr || arx->b == 0) return;
  const estimator::Structure structure{arx->a, arx->b, arx->k, arx->constant};
  std::vector<std::span<const double>> reference;
  const std::vector<double>* column = ground.record->column("reference_m");
  if (column == nullptr) column = ground.record->column("ref_m");
  if (column == nullptr) column = ground.record->column("r_m");
  if (column != nullptr) {
    for (const Stretch& stretch : ground.fitted) {
      const auto from = static_cast<std::size_t>(stretch.y_m.data() - ground.y_m.data());
      const std::span<const double> part = std::span(*column).subspan(from, stretch.y_m.size());
      if (!std::all_of(part.begin(), part.end(), [](double x) { return std::isfinite(x); })) break;
      reference.push_back(part);
    }
  }
  judged.bias = structures::test_bias(structure, ground.fitted, reference);
  judged.has_bias_test = true;
}

Judged judge(const Candidate& candidate, const Ground& ground,
             const std::function<bool()>& cancel) {
  const auto start = std::chrono::steady_clock::now();
  Judged out;
  out.candidate = candidate;
  out.fitted = fit(candidate, ground.fitted, nullptr, cancel);
  out.fit_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!out.fitted.valid) {
    out.on_line = on_line_form(candidate, out.fitted);
    return out;
  }
  score(out, ground);
  test_closed_loop(out, ground);
  run_on_line(out, ground);
  score_spread(out, ground, cancel);
  return out;
}

}  // namespace

Outcome compare_structures(const Request& request,
                           const std::function<void(const Progress&)>& progress,
                           const std::function<bool()>& cancel) {
  const auto start = std::chrono::steady_clock::now();
  Outcome out;
  out.request = request;
  for (const std::string& name : request.structures) {
    static_cast<void>(parse_candidate(name, 1, request.constant));  // before the record is read
  }
  const config::record::Record record = config::record::read_record(request.record);
  out.notes = record.notes;
  out.name = record.name;
  out.sample_time_s = record.sample_time_s;
  out.samples = record.size();
  out.gaps = record.gaps.size();
  const Ground ground = prepare(record, request, out);
  out.from_s = record.t_s.front();
  out.fitted_to_s = record.t_s[ground.split];
  out.scored_to_s = record.t_s.back();
  out.period_s = ground.period * record.sample_time_s;
  out.noise_floor_m = estimator::residual::noise_floor(record.y_m, record.sample_time_s).sd_m;
  out.delay = request.delay >= 0 ? request.delay : find_delay(ground);
  std::vector<Candidate> candidates;
  for (const std::string& name : request.structures) {
    candidates.push_back(parse_candidate(name, out.delay, request.constant));
  }
  if (candidates.empty()) candidates = usual_candidates(out.delay, request.constant);

  std::vector<Judged> judged(candidates.size());
  std::mutex mutex;
  std::size_t done = 0;
  const unsigned threads =
      request.threads > 0 ? request.threads : std::max(1u, std::thread::hardware_concurrency());
  diagnose::in_parallel(candidates.size(), threads, [&](std::size_t i) {
    if (cancel()) return;
    judged[i] = judge(candidates[i], ground, cancel);
    const std::lock_guard lock(mutex);
    progress({candidates[i].name, ++done, candidates.size()});
  });
  for (Judged& one : judged) {
    if (!one.candidate.name.empty()) out.judged.push_back(std::move(one));
  }
  out.interrupted = cancel();
  for (const Judged& one : out.judged) {
    out.held_out_periods =
        std::max(out.held_out_periods, static_cast<int>(one.period_costs_m2.size()));
  }
  recommend(out);
  out.runtime_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace workbench::select
