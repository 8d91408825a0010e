#include "workbench/scorecard/trials.h"

#include <algorithm>
#include <ctime>
#include <limits>
#include <map>

#include "config/schema/error.h"
#include "workbench/scorecard/search.h"
#include "workbench/simulate/closed_loop.h"

namespace workbench::scorecard {
namespace {

using nlohmann::json;

double processor_s() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void add(std::atomic<double>& sum, double value) {
  double before = sum;
  while (!sum.compare_exchange_weak(before, before + value)) {
  }
}

json to_json(const TrialAnswer& answer) {
  return {{"verdict", to_string(answer.verdict)},
          {"delay_s", answer.detected() ? json(answer.delay_s) : json(nullptr)},
          {"first", answer.first}};
}

}  // namespace

/// The methods of one part, each with its pipeline.
class Trials::Runners {
 public:
  Runners(Trials& trials, std::size_t motion, const std::vector<std::size_t>& which)
      : trials_(trials), which_(which) {
    const Trained& trained = trials.trained(motion);
    for (const std::size_t method : which) {
      unusable_.push_back(trained.unusable[method]);
      watches_.push_back(trained.unusable[method].empty()
                             ? std::make_unique<DetectionTrial>(trained.configs[method],
                                                                simulate::kSampleTime_s,
                                                                trials.methods_[method].notices)
                             : nullptr);
    }
  }

  [[nodiscard]] std::size_t size() const { return watches_.size(); }
  [[nodiscard]] bool usable(std::size_t i) const { return watches_[i] != nullptr; }
  [[nodiscard]] json result(std::size_t i, json found) const {
    return usable(i) ? std::move(found) : json{{"unusable", unusable_[i]}};
  }

  [[nodiscard]] DetectionTrial& watch(std::size_t i) { return *watches_[i]; }
  /// `f(DetectionTrial&)` with its time taken; `rig_s`: of the record.
  template <class F>
  auto with(std::size_t i, double rig_s, const F& f) {
    const double begin_s = processor_s();
    auto out = f(*watches_[i]);
    Cost& cost = *trials_.costs_[which_[i]];
    add(cost.processor_s, processor_s() - begin_s);
    add(cost.rig_s, rig_s);
    return out;
  }

 private:
  Trials& trials_;
  const std::vector<std::size_t>& which_;
  std::vector<std::string> unusable_;
  std::vector<std::unique_ptr<DetectionTrial>> watches_;
};

Trials::Trials(const Bench& bench, std::vector<Method> methods, const Scope& scope)
    : bench_(bench), methods_(std::move(methods)), scope_(scope) {
  for (std::size_t i = 0; i < bench.plan.motions.size(); ++i) {
    trained_.push_back(std::make_unique<Trained>());
  }
  for (std::size_t i = 0; i < methods_.size(); ++i) costs_.push_back(std::make_unique<Cost>());
}

double Trials::load_ratio(std::size_t method) const {
  const Cost& cost = *costs_[method];
  return cost.rig_s > 0.0 ? cost.processor_s / cost.rig_s
                          : std::numeric_limits<double>::quiet_NaN();
}

const Trials::Trained& Trials::trained(std::size_t motion) {
  Trained& out = *trained_[motion];
  std::call_once(out.once, [&] {
    const Lessons taught = lessons(bench_, bench_.plan.motions[motion], scope_.seed,
                                   std::any_of(methods_.begin(), methods_.end(), needs_faults));
    for (const Method& method : methods_) {
      std::string why;
      estimator::fdi::PipelineConfig config = method.pipeline;
      try {
        config = learn(method, taught);
      } catch (const config::schema::DataError& error) {
        why = error.what();
      }
      out.configs.push_back(std::move(config));
      out.unusable.push_back(std::move(why));
    }
  });
  return out;
}

/// Trials of the same number have the same noise and phase whatever the size.
Samples Trials::record_of(const Part& part, const Injected& injected, std::size_t trial) const {
  const Motion& motion = bench_.plan.motions[part.motion];
  const std::uint64_t seed =
      seed_of(scope_.seed, motion.id + "/" + injected.fault->id + "/" + std::to_string(trial));
  Injected timed = injected;
  timed.at_s = bench_.plan.lead_s + bench_.plan.phase_s * unit_of(seed);
  return scorecard::run(faulty(bench_, motion, timed), timed.at_s + bench_.plan.watch_s, seed);
}

/// One part on its way.
struct Trials::Turn {
  const Part& part;
  Runners& runners;
  const std::function<bool()>& stop;
  std::vector<json> out;  ///< one for each method

  template <class F>
  void each(const F& f) {
    for (std::size_t i = 0; i < runners.size() && !stop(); ++i) {
      if (runners.usable(i)) f(i);
    }
  }
};

/// Hours without a fault.
void Trials::quiet(Turn& turn) const {
  const Motion& motion = bench_.plan.motions[turn.part.motion];
  const double record_s = bench_.plan.part_h * kHour_s;
  const Samples samples =
      scorecard::run(turn.part.kind == Part::Kind::healthy
                         ? healthy(bench_, motion)
                         : changed(bench_, motion, bench_.plan.benign[turn.part.subject]),
                     record_s, seed_of(scope_.seed, turn.part.id));
  turn.each([&](std::size_t i) {
    const Quiet q =
        turn.runners.with(i, record_s, [&](DetectionTrial& w) { return w.quiet(samples); });
    turn.out[i] = {{"hours", bench_.plan.part_h},
                   {"alarms", q.alarms},
                   {"alarm_s", q.alarm_s},
                   {"invalid_s", q.invalid_s}};
  });
}

/// Answer of a method to a record with a fault, which ends watch_s after it.
TrialAnswer Trials::answer(Turn& turn, std::size_t method, const Samples& samples, bool to_the_end,
                           DetectionTrial::Lead* lead) const {
  const double end_s = static_cast<double>(samples.size()) * simulate::kSampleTime_s;
  const double at_s = end_s - bench_.plan.watch_s;
  const Fault& fault = bench_.plan.faults[turn.part.subject];
  const auto judge = [&](DetectionTrial& w) {
    return w.fault(samples, at_s, fault.names, to_the_end, lead);
  };
  // A method that stops early has taken an unknown part of the record.
  return to_the_end ? turn.runners.with(method, end_s, judge) : judge(turn.runners.watch(method));
}

/// The stated size of a fault: delays and names.
void Trials::stated(Turn& turn) const {
  const Fault& fault = bench_.plan.faults[turn.part.subject];
  for (json& one : turn.out) one = {{"answers", json::array()}};
  for (std::int64_t trial = 0; trial < scope_.seeds && !turn.stop(); ++trial) {
    const Samples samples = record_of(turn.part, {&fault, turn.part.direction, fault.stated, 0.0},
                                      static_cast<std::size_t>(trial));
    turn.each([&](std::size_t i) {
      turn.out[i]["answers"].push_back(to_json(answer(turn, i, samples, true)));
    });
  }
}

/// Share detected of one size, for each method; those whose share is decided stop early.
std::vector<Trials::Count> Trials::rung(
    Turn& turn, const std::vector<std::size_t>& methods, double size,
    std::vector<std::vector<DetectionTrial::Lead>>& leads) const {
  const Fault& fault = bench_.plan.faults[turn.part.subject];
  const auto trials = static_cast<std::size_t>(scope_.seeds);
  std::vector<Count> counts(methods.size());
  const auto open = [&](const Count& c) {
    return !decided(c.detected, c.tried, trials, kDetected);
  };
  for (std::size_t trial = 0; trial < trials && !turn.stop(); ++trial) {
    if (std::none_of(counts.begin(), counts.end(), open)) break;
    const Samples samples = record_of(turn.part, {&fault, turn.part.direction, size, 0.0}, trial);
    for (std::size_t k = 0; k < methods.size(); ++k) {
      if (!open(counts[k])) continue;
      ++counts[k].tried;
      DetectionTrial::Lead& lead = leads[methods[k]][trial];
      if (answer(turn, methods[k], samples, false, &lead).detected()) ++counts[k].detected;
    }
  }
  return counts;
}

/// The smallest size that each method detects. Methods that ask for the same rung share its
/// records.
void Trials::ladder(Turn& turn) const {
  const auto trials = static_cast<std::size_t>(scope_.seeds);
  const std::vector<double> sizes =
      bench_.plan.faults[turn.part.subject].sizes(turn.part.direction);
  std::vector<LadderSearch> searches(turn.out.size(), LadderSearch(sizes.size()));
  std::vector<std::vector<DetectionTrial::Lead>> leads(turn.out.size(),
                                                       std::vector<DetectionTrial::Lead>(trials));
  for (json& one : turn.out) one = {{"smallest", nullptr}, {"rungs", json::array()}};
  for (;;) {
    std::map<std::size_t, std::vector<std::size_t>> asked;
    for (std::size_t i = 0; i < turn.runners.size(); ++i) {
      const auto next = searches[i].next();
      if (next && turn.runners.usable(i)) asked[*next].push_back(i);
    }
    if (asked.empty() || turn.stop()) return;
    for (const auto& [number, methods] : asked) {
      const std::vector<Count> counts = rung(turn, methods, sizes[number], leads);
      if (turn.stop()) return;
      for (std::size_t k = 0; k < methods.size(); ++k) {
        const std::size_t i = methods[k];
        searches[i].tell(*decided(counts[k].detected, counts[k].tried, trials, kDetected));
        turn.out[i]["rungs"].push_back({{"size", sizes[number]},
                                        {"detected", counts[k].detected},
                                        {"tried", counts[k].tried}});
        if (const auto smallest = searches[i].smallest()) {
          turn.out[i]["smallest"] = sizes[*smallest];
        }
      }
    }
  }
}

std::vector<json> Trials::run(const Part& part, const std::vector<std::size_t>& which,
                              const std::function<bool()>& stop) {
  Runners runners(*this, part.motion, which);
  Turn turn{part, runners, stop, std::vector<json>(which.size())};
  switch (part.kind) {
    case Part::Kind::healthy:
    case Part::Kind::benign:
      quiet(turn);
      break;
    case Part::Kind::stated:
      stated(turn);
      break;
    case Part::Kind::ladder:
      ladder(turn);
      break;
  }
  if (stop()) return {};
  for (std::size_t i = 0; i < turn.out.size(); ++i) {
    turn.out[i] = runners.result(i, std::move(turn.out[i]));
  }
  return turn.out;
}

}  // namespace workbench::scorecard
