#include "workbench/select/judge.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "estimator/residual/whiteness.h"
#include "estimator/structure.h"
#include "estimator/structures/recursive_prediction_error.h"

namespace workbench::select {
namespace {

using structures::Stretch;

constexpr double kReached = 1.5;  // times the batch fit's free run
constexpr int kWhitenessLags = 20;

void score_free_runs(JudgedStructure& judged, const Ground& ground) {
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
  judged.cost_m2 = count > 0 ? periods / count : kNaN;
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

void score(JudgedStructure& judged, const Ground& ground) {
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
void score_spread(JudgedStructure& judged, const Ground& ground,
                  const std::function<bool()>& cancel) {
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

void run_on_line(JudgedStructure& judged, const Ground& ground) {
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
  JudgedStructure found;
  found.fitted.model = structures::from_values(*orders, filter.value());
  score_free_runs(found, ground);
  judged.on_line.free_run_rms_m = found.free_run_rms_m;
  if (!(found.free_run_rms_m <= kReached * judged.free_run_rms_m)) {
    judged.on_line.sound = false;
    judged.on_line.why = "its recursion does not converge to the batch fit on this record";
  }
}

void test_closed_loop(JudgedStructure& judged, const Ground& ground) {
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

}  // namespace

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

JudgedStructure judge(const StructureCandidate& candidate, const Ground& ground,
                      const std::function<bool()>& cancel) {
  const auto start = std::chrono::steady_clock::now();
  JudgedStructure out;
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

namespace {

constexpr double kMostPole = 0.999;  // largest pole of F: the recursive filter's own limit
constexpr const char* kIntegrates =
    "its poles reach the unit circle: the prediction, never corrected by y, would diverge";

}  // namespace

OnLine on_line_form(const StructureCandidate& candidate, const Fitted& fitted) {
  OnLine out;
  out.method = "none";
  if (std::holds_alternative<structures::SubspaceOptions>(candidate.what)) {
    out.why =
        "recursive subspace methods change their state basis over time; ARMAX represents the same "
        "transfer functions";
    return out;
  }
  if (std::holds_alternative<structures::NarxOptions>(candidate.what)) {
    out.why = "its weights are not determined individually, and no recursion is proven to converge";
    return out;
  }
  const structures::Orders& o = std::get<structures::Orders>(candidate.what);
  if (o.f > 0) {
    const auto* model = std::get_if<structures::Polynomial>(&fitted.model);
    if (!fitted.valid || model == nullptr || structures::largest_root(model->f) > kMostPole) {
      out.why = kIntegrates;
      return out;
    }
    out.method = "RPEM";
  } else {
    out.method = o.c > 0 ? "RML" : "RLS";
  }
  out.sound = true;
  return out;
}

}  // namespace workbench::select
