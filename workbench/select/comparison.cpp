// Drives the comparison: prepares the record, fits and scores every structure.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <thread>

#include "config/schema/error.h"
#include "estimator/parallel.h"
#include "estimator/residual/noise_floor.h"
#include "workbench/select/candidate.h"
#include "workbench/select/judge.h"

namespace workbench::select {
namespace {

using structures::Stretch;
using structures::Stretches;

constexpr double kKnownBefore_s = 0.25;  // measured samples before a free run
constexpr int kLeastPeriods = 3;
constexpr int kLeastPeriod = 20;  // samples
constexpr int kMostDelay = 10;
constexpr double kClear = 10.0;  // difference in BIC: "very strong" evidence (Kass, Raftery 1995)

int in_samples(double time_s, double sample_time_s) {
  return static_cast<int>(std::clamp(std::round(time_s / sample_time_s), 1.0, 1e9));
}

Ground prepare(const config::record::Record& record, const SelectRequest& request,
               SelectOutcome& outcome) {
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

}  // namespace

SelectOutcome compare_structures(const SelectRequest& request,
                                 const std::function<void(const SelectProgress&)>& progress,
                                 const std::function<bool()>& cancel) {
  const auto start = std::chrono::steady_clock::now();
  SelectOutcome out;
  out.request = request;
  for (const std::string& name : request.structures) {
    static_cast<void>(parse_candidate(name, 1, request.constant));  // before the record is read
  }
  const config::record::Record record =
      config::record::read_record(request.record, request.reading);
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
  if (request.delay < 0 && out.delay == kMostDelay) {
    out.notes.push_back("the delay found is the longest one tried; try a longer one with --delay");
  }
  std::vector<StructureCandidate> candidates;
  for (const std::string& name : request.structures) {
    candidates.push_back(parse_candidate(name, out.delay, request.constant));
  }
  if (candidates.empty()) candidates = usual_candidates(out.delay, request.constant);

  std::vector<JudgedStructure> judged(candidates.size());
  std::mutex mutex;
  std::size_t done = 0;
  const unsigned threads =
      request.threads > 0 ? request.threads : std::max(1u, std::thread::hardware_concurrency());
  estimator::in_parallel(candidates.size(), threads, [&](std::size_t i) {
    if (cancel()) return;
    judged[i] = judge(candidates[i], ground, cancel);
    const std::lock_guard lock(mutex);
    progress({candidates[i].name, ++done, candidates.size()});
  });
  for (JudgedStructure& one : judged) {
    if (!one.candidate.name.empty()) out.judged.push_back(std::move(one));
  }
  out.interrupted = cancel();
  for (const JudgedStructure& one : out.judged) {
    out.held_out_periods =
        std::max(out.held_out_periods, static_cast<int>(one.period_costs_m2.size()));
  }
  recommend(out);
  out.runtime_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace workbench::select