#include "workbench/reproduce/alarm_run.h"

#include <cassert>
#include <cmath>
#include <limits>

#include "config/schema/document.h"
#include "config/signals/nan.h"
#include "workbench/reproduce/thesis_scenarios.h"
#include "workbench/simulate/closed_loop.h"

namespace workbench::reproduce {
namespace {

namespace fdi = estimator::fdi;

class AlarmRecorder final : public fdi::Events {
 public:
  explicit AlarmRecorder(Keep keep) : keep_(keep) {}

  void on_estimate(const fdi::EstimateEvent& event) override {
    if (keep_ == Keep::alarms) return;
    found.estimates.push_back({time_s(event.tick), std::string(event.source), event.value("b1"),
                               event.valid && !event.warming_up});
  }
  void on_alarm(const fdi::Alarm& alarm) override {
    found.changes.push_back({time_s(alarm.tick), alarm.name, alarm.direction, alarm.active});
  }

  AlarmRun found;

 private:
  static double time_s(std::int64_t tick) {
    return static_cast<double>(tick) * simulate::kSampleTime_s;
  }
  Keep keep_;
};

}  // namespace

double AlarmRun::next(double after_s, int direction) const noexcept {
  using config::signals::kNaN;
  for (const AlarmChange& change : changes) {
    if (change.t_s < after_s) continue;
    return change.direction == direction && change.active == (direction != 0) ? change.t_s : kNaN;
  }
  return kNaN;
}

double AlarmRun::first(double after_s, int direction) const noexcept {
  for (const AlarmChange& change : changes) {
    if (change.t_s >= after_s && change.active && change.direction == direction) return change.t_s;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

AlarmRun run_with_alarms(const Scenario& scenario, const fdi::PipelineConfig& config,
                         double duration_s, std::uint64_t seed, Keep keep) {
  simulate::ClosedLoop loop(scenario, seed);
  fdi::Pipeline pipeline(config, simulate::kSampleTime_s);
  AlarmRecorder recorder(keep);
  const std::int64_t samples = std::llround(duration_s / simulate::kSampleTime_s);
  for (std::int64_t tick = 0; tick < samples; ++tick) {
    const simulate::LoopRow row = loop.step();
    config::signals::Sample sample;
    sample.tick = tick;
    sample.t_read_ns = std::llround(row.t_s * 1e9);
    sample.t_write_ns = sample.t_read_ns;
    sample.reference_m = row.reference_m;
    sample.y_m = row.y_m;
    sample.u_requested_V = row.u_requested_V;
    sample.u_applied_V = row.u_applied_V;
    sample.saturated = row.saturated;
    pipeline.process(sample, recorder);
  }
  return std::move(recorder.found);
}

fdi::EstimatorConfig period_estimator(const char* structure) {
  fdi::EstimatorConfig config;
  config.id = "period";
  config.structure = structure;
  config.method = "batch";
  config.window_s = 2.0;
  config.offset_m = kOffset_m;
  config.warmup_s = 2.0;
  return config;
}

fdi::PipelineConfig shipped_sliding_window() {
  const char* const file = "thesis_case1.toml";
  fdi::PipelineConfig config;
  config::schema::Document::parse(shipped_model_text(file), file)
      .read_part([&](config::schema::Visitor& v) { config.visit(v); });
  std::erase_if(config.estimators, [](const auto& estimator) { return estimator.id != "sliding"; });
  std::erase_if(config.bands, [](const auto& band) { return band.quantity != "sliding.b1"; });
  assert(config.estimators.size() == 1 && config.bands.size() == 1);
  return config;
}

fdi::PipelineConfig watching_b1(const fdi::EstimatorConfig& estimator, double low, double high) {
  fdi::BandConfig band;
  band.id = "b1";
  band.quantity = estimator.id + ".b1";
  band.low = low;
  band.high = high;
  fdi::PipelineConfig config;
  config.estimators.push_back(estimator);
  config.bands.push_back(band);
  return config;
}

}  // namespace workbench::reproduce
