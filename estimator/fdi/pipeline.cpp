#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "estimator/fdi/pipeline_impl.h"

namespace estimator::fdi {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double EstimateEvent::value(std::string_view name) const noexcept {
  for (const NamedValue& v : *this) {
    if (v.name == name) return v.value;
  }
  return kNan;
}

void Pipeline::Impl::judge(Watch& watch, const Reading& reading, Events& events) {
  const double t_s = static_cast<double>(reading.tick) * sample_time_s;
  const BandState::Result result =
      reading.trusted ? watch.state.update(reading.value, t_s) : watch.state.update_invalid(t_s);
  AlarmState state;
  state.severity = result.severity;
  state.direction = static_cast<std::int8_t>(result.direction);
  state.tick = reading.tick;
  state.value = reading.value;
  state.std_error = reading.std_error;
  const Alarm& alarm = book.alarm(watch.alarm);
  char text[Outlet::kReason + 160] = "";
  if (alarm.severity != state.severity || alarm.direction != state.direction) {
    int size = 0;
    if (result.severity == Severity::invalid) {
      size = std::snprintf(text, sizeof text, "%s cannot be trusted: %s", alarm.quantity.c_str(),
                           reading.why);
    } else if (result.direction != 0) {
      size = std::snprintf(text, sizeof text, "%s is %.6g, %s %.6g", alarm.quantity.c_str(),
                           reading.value, result.direction > 0 ? "above" : "below",
                           result.direction > 0 ? alarm.high : alarm.low);
    } else {
      size = std::snprintf(text, sizeof text, "%s is %.6g, inside its band", alarm.quantity.c_str(),
                           reading.value);
    }
    end_after_a_word(text, size);
  }
  state.reason = text;
  if (const Alarm* changed = book.set(watch.alarm, state)) events.on_alarm(*changed);
}

void Pipeline::Impl::emit(Worker& worker, std::int64_t tick, std::int64_t utc_us, Events& events) {
  Outlet& outlet = *worker.outlet;
  outlet.finding = worker.source->find(outlet.values);
  end_after_a_word(outlet.reason,
                   std::snprintf(outlet.reason, sizeof outlet.reason, "%s", outlet.finding.reason));
  outlet.finding.reason = outlet.reason;
  outlet.fresh = true;
  const Finding& found = outlet.finding;
  events.on_estimate({worker.number, worker.id, tick, utc_us, found.valid, found.warming_up,
                      outlet.reason, found.condition, found.samples, outlet.values.data(),
                      outlet.values.data() + outlet.values.size()});
  if (found.warming_up) return;
  for (std::size_t i = 0; i < outlet.values.size(); ++i) {
    const NamedValue& value = outlet.values[i];
    for (Watch& watch : worker.watches[i]) {
      judge(watch, {value.value, value.std_error, found.valid, outlet.reason, tick}, events);
    }
  }
  for (std::size_t i = 0; i < worker.own_alarms.size(); ++i) {
    AlarmState state = worker.source->own_alarm(i);
    state.tick = tick;
    if (const Alarm* changed = book.set(worker.own_alarms[i], state)) events.on_alarm(*changed);
  }
}

void Pipeline::Impl::take(const config::signals::Sample& taken) {
  for (std::size_t i = 0; i < kSampleQuantities.size(); ++i) {
    sample.values[i].value = value_of(kSampleQuantities[i].quantity, taken);
  }
  sample.fresh = true;
  for (Worker& worker : workers) worker.outlet->fresh = false;
}

Pipeline::Pipeline(const PipelineConfig& config, double sample_time_s)
    : impl_(std::make_unique<Impl>(config, sample_time_s)) {}
Pipeline::~Pipeline() = default;
Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;

void Pipeline::process(const config::signals::Sample& sample, Events& events) {
  Impl& impl = *impl_;
  std::int64_t lost = 0;
  if (impl.started && sample.tick <= impl.last_tick) {
    for (Worker& worker : impl.workers) {
      worker.source->reset();
      worker.outlet->reset();
    }
  } else if (impl.started) {
    lost = std::max<std::int64_t>(sample.gap, sample.tick - impl.last_tick - 1);
  }
  impl.started = true;
  impl.last_tick = sample.tick;
  impl.book.advance(sample.tick, sample.utc_us,
                    [&events](const Alarm& alarm) { events.on_alarm(alarm); });
  impl.take(sample);
  const double y_m = usable_y_m(sample);
  for (Worker& worker : impl.workers) {
    Source& source = *worker.source;
    if (lost > 0 && source.lose(lost)) impl.emit(worker, sample.tick - 1, sample.utc_us, events);
    if (source.push(sample, y_m)) impl.emit(worker, sample.tick, sample.utc_us, events);
  }
  for (SampleWatch& watched : impl.sample_watches) {
    const double value = impl.sample.values[watched.quantity].value;
    impl.judge(watched.watch, {value, kNan, std::isfinite(value), "no good reading", sample.tick},
               events);
  }
}

void Pipeline::reset() {
  impl_->started = false;
  for (Worker& worker : impl_->workers) {
    worker.source->reset();
    worker.outlet->reset();
  }
  impl_->for_each_watch([](Watch& watch) { watch.state.reset(); });
  impl_->book.reset();
}

AlarmBook& Pipeline::alarms() noexcept { return impl_->book; }
const AlarmBook& Pipeline::alarms() const noexcept { return impl_->book; }

}  // namespace estimator::fdi
