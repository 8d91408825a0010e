#include "workbench/scorecard/trials.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <map>
#include <numeric>

#include "config/schema/error.h"
#include "workbench/scorecard/search.h"
#include "workbench/scorecard/statistics.h"
#include "workbench/simulate/closed_loop.h"

namespace workbench::scorecard {
namespace {

using nlohmann::json;

constexpr double kHour_s = 3600.0;

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

json to_json(const Answer& answer) {
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
      watches_.push_back(
          trained.unusable[method].empty()
              ? std::make_unique<Watch>(trained.configs[method], simulate::kSampleTime_s)
              : nullptr);
    }
  }

  [[nodiscard]] std::size_t size() const { return watches_.size(); }
  [[nodiscard]] bool usable(std::size_t i) const { return watches_[i] != nullptr; }
  [[nodiscard]] json result(std::size_t i, json found) const {
    return usable(i) ? std::move(found) : json{{"unusable", unusable_[i]}};
  }

  /// `f(Watch&)` with its time taken; `rig_s`: at most so long a record.
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
  std::vector<std::unique_ptr<Watch>> watches_;
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
      } catch (const config::schema::Error& error) {
        if (error.exit_code() != static_cast<int>(config::schema::ExitCode::bad_data)) throw;
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
  Samples samples =
      scorecard::run(faulty(bench_, motion, timed), timed.at_s + bench_.plan.watch_s, seed);
  return samples;
}

namespace {

double fault_at_s(const Samples& samples, double watch_s) {
  return static_cast<double>(samples.size()) * simulate::kSampleTime_s - watch_s;
}

}  // namespace

std::vector<json> Trials::run(const Part& part, const std::vector<std::size_t>& which,
                              const std::function<bool()>& stop) {
  Runners runners(*this, part.motion, which);
  const Plan& plan = bench_.plan;
  const Motion& motion = plan.motions[part.motion];
  std::vector<json> out(which.size());
  const auto each = [&](const auto& f) {
    for (std::size_t i = 0; i < runners.size() && !stop(); ++i) {
      if (runners.usable(i)) f(i);
    }
  };

  if (part.kind == Part::Kind::healthy || part.kind == Part::Kind::benign) {
    const double record_s = plan.part_h * kHour_s;
    const Samples samples = scorecard::run(part.kind == Part::Kind::healthy
                                               ? healthy(bench_, motion)
                                               : changed(bench_, motion, plan.benign[part.subject]),
                                           record_s, seed_of(scope_.seed, part.id));
    each([&](std::size_t i) {
      const Quiet q = runners.with(i, record_s, [&](Watch& w) { return w.quiet(samples); });
      out[i] = {{"hours", plan.part_h},
                {"alarms", q.alarms},
                {"alarm_s", q.alarm_s},
                {"invalid_s", q.invalid_s}};
    });
  } else {
    const Fault& fault = plan.faults[part.subject];
    const auto trials = static_cast<std::size_t>(scope_.seeds);
    const auto answer = [&](std::size_t i, const Samples& samples, bool to_the_end) {
      const double at_s = fault_at_s(samples, plan.watch_s);
      return runners.with(i, to_the_end ? at_s + plan.watch_s : at_s, [&](Watch& w) {
        return w.fault(samples, at_s, fault.names, to_the_end);
      });
    };
    if (part.kind == Part::Kind::stated) {
      for (json& one : out) one = {{"answers", json::array()}};
      for (std::size_t trial = 0; trial < trials && !stop(); ++trial) {
        const Samples samples = record_of(part, {&fault, part.direction, fault.stated, 0.0}, trial);
        each(
            [&](std::size_t i) { out[i]["answers"].push_back(to_json(answer(i, samples, true))); });
      }
    } else {
      const std::vector<double> sizes = fault.sizes(part.direction);
      std::vector<LadderSearch> searches(which.size(), LadderSearch(sizes.size()));
      for (json& one : out) one = {{"smallest", nullptr}, {"rungs", json::array()}};
      // Methods that ask for the same rung share its records.
      for (;;) {
        std::map<std::size_t, std::vector<std::size_t>> asked;
        for (std::size_t i = 0; i < runners.size(); ++i) {
          if (const auto rung = searches[i].next(); rung && runners.usable(i)) {
            asked[*rung].push_back(i);
          }
        }
        if (asked.empty() || stop()) break;
        for (const auto& [rung, methods] : asked) {
          std::vector<std::size_t> detected(methods.size());
          std::vector<std::size_t> tried(methods.size());
          std::vector<char> open(methods.size(), 1);
          for (std::size_t trial = 0; trial < trials && !stop(); ++trial) {
            if (std::find(open.begin(), open.end(), 1) == open.end()) break;
            const Samples samples =
                record_of(part, {&fault, part.direction, sizes[rung], 0.0}, trial);
            for (std::size_t k = 0; k < methods.size(); ++k) {
              if (open[k] == 0) continue;
              ++tried[k];
              if (answer(methods[k], samples, false).detected()) ++detected[k];
              open[k] = decided(detected[k], tried[k], trials, kDetected) ? 0 : 1;
            }
          }
          if (stop()) break;
          for (std::size_t k = 0; k < methods.size(); ++k) {
            const std::size_t i = methods[k];
            searches[i].tell(*decided(detected[k], tried[k], trials, kDetected));
            out[i]["rungs"].push_back(
                {{"size", sizes[rung]}, {"detected", detected[k]}, {"tried", tried[k]}});
            if (const auto smallest = searches[i].smallest()) {
              out[i]["smallest"] = sizes[*smallest];
            }
          }
        }
      }
    }
  }
  if (stop()) return {};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = runners.result(i, std::move(out[i]));
  return out;
}

}  // namespace workbench::scorecard
