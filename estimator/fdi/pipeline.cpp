#include "estimator/fdi/pipeline.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "estimator/fdi/estimation_method.h"
#include "estimator/fdi/pipeline_impl.h"

namespace estimator::fdi {

double EstimateEvent::value(std::string_view name) const noexcept {
  for (const EstimatedValue& v : *this) {
    if (v.name == name) return v.value;
  }
  return kNaN;
}

void Pipeline::Impl::monitor_band(BandMonitor& monitor, const MonitoredValue& value,
                                  Events& events) {
  const double t_s = static_cast<double>(value.tick) * sample_time_s;
  const BandState::Result result = value.trusted    ? monitor.state.update(value.value, t_s)
                                   : value.expected ? monitor.state.update_invalid(t_s)
                                                    : monitor.state.rest();
  AlarmInput input;
  input.severity = result.severity;
  input.direction = static_cast<std::int8_t>(result.direction);
  input.tick = value.tick;
  input.value = value.value;
  input.std_error = value.std_error;
  const Alarm& alarm = book.alarm(monitor.alarm);
  char text[OutputPort::kReason + 160] = "";
  if (alarm.severity != input.severity || alarm.direction != input.direction) {
    int size = 0;
    if (result.severity == Severity::invalid) {
      size = std::snprintf(text, sizeof text, "%s cannot be trusted: %s", alarm.quantity.c_str(),
                           value.why);
    } else if (result.direction != 0) {
      size = std::snprintf(text, sizeof text, "%s is %.6g, %s %.6g", alarm.quantity.c_str(),
                           value.value, result.direction > 0 ? "above" : "below",
                           result.direction > 0 ? alarm.high : alarm.low);
    } else if (!value.trusted) {
      size = std::snprintf(text, sizeof text, "%s: the rig rests", alarm.quantity.c_str());
    } else {
      size = std::snprintf(text, sizeof text, "%s is %.6g, inside its band", alarm.quantity.c_str(),
                           value.value);
    }
    end_after_a_word(text, size);
  }
  input.reason = text;
  if (const Alarm* changed = book.set(monitor.alarm, input)) events.on_alarm(*changed);
}

void Pipeline::Impl::evaluate(MethodSlot& slot, std::int64_t tick, std::int64_t utc_us,
                              Events& events) {
  OutputPort& port = *slot.port;
  port.output = slot.method->evaluate(port.values);
  end_after_a_word(port.reason,
                   std::snprintf(port.reason, sizeof port.reason, "%s", port.output.reason));
  port.output.reason = port.reason;
  port.fresh = true;
  const MethodOutput& found = port.output;
  events.on_estimate({slot.number, slot.id, tick, utc_us, found.valid, found.warming_up,
                      port.reason, found.condition, found.samples, port.values.data(),
                      port.values.data() + port.values.size()});
  if (found.warming_up && !at_rest) return;
  const bool trusted = found.valid && !found.warming_up;
  for (std::size_t i = 0; i < port.values.size(); ++i) {
    const EstimatedValue& value = port.values[i];
    for (BandMonitor& monitor : slot.monitors[i]) {
      monitor_band(monitor, {value.value, value.std_error, trusted, !at_rest, port.reason, tick},
                   events);
    }
  }
  for (std::size_t i = 0; i < slot.declared_alarms.size(); ++i) {
    AlarmInput input = slot.method->alarm_input(i);
    input.tick = tick;
    if (const Alarm* changed = book.set(slot.declared_alarms[i], input)) events.on_alarm(*changed);
  }
}

void Pipeline::Impl::update_sample(const config::signals::Sample& next) {
  for (std::size_t i = 0; i < kSampleQuantities.size(); ++i) {
    sample.values[i].value = value_of(kSampleQuantities[i].quantity, next);
  }
  sample.fresh = true;
  for (MethodSlot& slot : slots) slot.port->fresh = false;
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
    for (MethodSlot& slot : impl.slots) {
      slot.method->reset();
      slot.port->reset();
    }
  } else if (impl.started) {
    lost = std::max<std::int64_t>(sample.gap, sample.tick - impl.last_tick - 1);
  }
  impl.started = true;
  impl.last_tick = sample.tick;
  impl.at_rest = rests(sample);
  impl.book.advance(sample.tick, sample.utc_us,
                    [&events](const Alarm& alarm) { events.on_alarm(alarm); });
  impl.update_sample(sample);
  const double y_m = usable_y_m(sample);
  for (MethodSlot& slot : impl.slots) {
    DetectionMethod& method = *slot.method;
    if (lost > 0 && method.on_gap(lost)) {
      impl.evaluate(slot, sample.tick - 1, sample.utc_us, events);
    }
    if (method.push(sample, y_m)) impl.evaluate(slot, sample.tick, sample.utc_us, events);
  }
  for (SampleBandMonitor& each : impl.sample_monitors) {
    const double value = impl.sample.values[each.quantity].value;
    impl.monitor_band(each.monitor,
                      {value, kNaN, std::isfinite(value), true, "no good reading", sample.tick},
                      events);
  }
}

void Pipeline::reset() {
  impl_->started = false;
  for (MethodSlot& slot : impl_->slots) {
    slot.method->reset();
    slot.port->reset();
  }
  impl_->for_each_monitor([](BandMonitor& monitor) { monitor.state.reset(); });
  impl_->book.reset();
}

void Pipeline::serialize(StateArchive& archive) {
  Impl& impl = *impl_;
  archive.value(impl.started);
  archive.value(impl.last_tick);
  for (MethodSlot& slot : impl.slots) {
    slot.method->serialize(archive);
    slot.port->serialize(archive);
    for (std::vector<BandMonitor>& monitors : slot.monitors) {
      for (BandMonitor& monitor : monitors) archive.value(monitor.state);
    }
  }
  for (SampleBandMonitor& each : impl.sample_monitors) archive.value(each.monitor.state);
  impl.book.serialize(archive);
}

std::vector<bool> Pipeline::inherit(Pipeline& before) {
  Impl& to = *impl_;
  Impl& from = *before.impl_;
  to.started = from.started;
  to.last_tick = from.last_tick;
  std::vector<bool> continues(to.slots.size(), false);
  std::vector<std::uint8_t> bytes;
  for (MethodSlot& slot : to.slots) {
    MethodSlot* const old = from.slot(slot.id);
    if (old == nullptr || old->settings != slot.settings) continue;
    bytes.clear();
    StateArchive out = StateArchive::saving(bytes);
    old->method->serialize(out);
    old->port->serialize(out);
    StateArchive in = StateArchive::restoring(bytes);
    slot.method->serialize(in);
    slot.port->serialize(in);
    continues[slot.number] = true;
  }
  to.for_each_monitor([&](BandMonitor& monitor) {
    const Alarm& alarm = to.book.alarm(monitor.alarm);
    from.for_each_monitor([&](const BandMonitor& old) {
      const Alarm& was = from.book.alarm(old.alarm);
      if (was.name == alarm.name && was.quantity == alarm.quantity)
        monitor.state.inherit(old.state);
    });
  });
  to.book.inherit(from.book);
  return continues;
}

AlarmBook& Pipeline::alarms() noexcept { return impl_->book; }
const AlarmBook& Pipeline::alarms() const noexcept { return impl_->book; }

}  // namespace estimator::fdi
