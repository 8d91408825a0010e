#include "estimator/fdi/pipeline.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "estimator/fdi/detection_method.h"
#include "estimator/fdi/estimator_channel.h"

namespace estimator::fdi {

// Internals of Pipeline, for its own files only.

/// A band and its alarm.
struct BandMonitor {
  BandState state;
  std::size_t alarm;  ///< number in the book
};

struct MonitoredValue {
  double value;
  double std_error;
  bool trusted;
  const char* why;  ///< reason of an untrusted value
  std::int64_t tick;
};

struct MethodSlot {
  std::size_t number;  ///< in PipelineConfig::method_ids()
  std::string id;
  std::unique_ptr<DetectionMethod> method;
  std::unique_ptr<OutputPort> port;
  std::string settings;            ///< fingerprint, then those of the methods that this one reads
  std::vector<std::string> names;  ///< names of the values
  std::vector<std::vector<BandMonitor>> monitors;  ///< for each value
  std::vector<std::size_t> declared_alarms;        ///< numbers in the book
};

struct SampleBandMonitor {
  std::size_t quantity;  ///< number in kSampleQuantities
  BandMonitor monitor;
};

struct Pipeline::Impl final : private InputResolver {
  std::vector<MethodSlot> slots;  ///< in order of evaluation: each after its inputs
  OutputPort sample;              ///< the present sample's own quantities
  std::vector<SampleBandMonitor> sample_monitors;
  AlarmBook book;
  double sample_time_s = 0.0;
  bool started = false;
  std::int64_t last_tick = 0;

  Impl(const PipelineConfig& config, double sample_time);
  void add_methods(const PipelineConfig& config);
  void add(std::size_t number, const std::string& id, std::unique_ptr<DetectionMethod> method,
           std::string settings);
  void add(const BandConfig& band);
  void update_sample(const config::signals::Sample& next);
  void evaluate(MethodSlot& slot, std::int64_t tick, std::int64_t utc_us, Events& events);
  void monitor_band(BandMonitor& monitor, const MonitoredValue& value, Events& events);
  [[nodiscard]] MethodSlot* slot(std::string_view id) noexcept;
  /// Indices of the slot (slots.size(): the sample) and of the value. Throws schema::Error at
  /// `where` for an unknown value.
  [[nodiscard]] std::pair<std::size_t, std::size_t> locate(const std::string& quantity,
                                                           const std::string& where) const;
  [[nodiscard]] MethodInput find(const std::string& quantity,
                                 const std::string& where) const override;
  template <class F>
  void for_each_monitor(F&& f) {
    for (MethodSlot& slot : slots) {
      for (std::vector<BandMonitor>& monitors : slot.monitors) {
        for (BandMonitor& monitor : monitors) f(monitor);
      }
    }
    for (SampleBandMonitor& each : sample_monitors) f(each.monitor);
  }
};

double EstimateEvent::value(std::string_view name) const noexcept {
  for (const NamedValue& v : *this) {
    if (v.name == name) return v.value;
  }
  return kNaN;
}

void Pipeline::Impl::monitor_band(BandMonitor& monitor, const MonitoredValue& value,
                                  Events& events) {
  const double t_s = static_cast<double>(value.tick) * sample_time_s;
  const BandState::Result result =
      value.trusted ? monitor.state.update(value.value, t_s) : monitor.state.update_invalid(t_s);
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
  if (found.warming_up) return;
  for (std::size_t i = 0; i < port.values.size(); ++i) {
    const NamedValue& value = port.values[i];
    for (BandMonitor& monitor : slot.monitors[i]) {
      monitor_band(monitor, {value.value, value.std_error, found.valid, port.reason, tick}, events);
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
                      {value, kNaN, std::isfinite(value), "no good reading", sample.tick}, events);
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

namespace {

using config::schema::bad_config;
using config::schema::joined;

double given(double limit) noexcept { return std::isinf(limit) ? kNaN : limit; }

Alarm alarm_for(const BandConfig& band, std::string_view source) {
  Alarm alarm;
  alarm.source = source;
  alarm.name = band.id;
  alarm.quantity = band.quantity;
  alarm.parameter = band.parameter;
  alarm.falls_with_parameter = band.falls_with_parameter;
  alarm.ambiguity_group = band.ambiguity_group;
  alarm.guidance = band.guidance;
  alarm.rules = band.rules;
  alarm.low = given(band.low);
  alarm.high = given(band.high);
  return alarm;
}

void check(const BandConfig& band, const std::string& where) {
  if (std::isinf(band.low) && std::isinf(band.high)) {
    throw bad_config(where, "has neither low nor high",
                     "limits here, or learned ones in bands_file");
  }
  if (!(band.low < band.high)) throw bad_config(where + ": low", "is not below high");
  if (2.0 * band.hysteresis >= band.high - band.low) {
    throw bad_config(where + ": hysteresis", "leaves no room inside the band",
                     "less than half of high - low");
  }
}

/// A method that waits for those that it reads.
struct PendingMethod {
  std::size_t number;
  std::string where;  ///< "[[cusum]] id"
  const DetectionMethodConfig* config;
};

}  // namespace

Pipeline::Impl::Impl(const PipelineConfig& config, double sample_time)
    : book(sample_time), sample_time_s(sample_time) {
  if (!(sample_time_s > 0.0)) throw bad_config("sample time", "is not positive");
  for (const NamedSampleQuantity& each : kSampleQuantities) {
    sample.values.push_back({each.name, kNaN, kNaN, kNaN, kNaN});
  }
  sample.output.valid = true;
  sample.interval_s = sample_time_s;
  add_methods(config);
  for (const BandConfig& band : config.bands) add(band);
}

void Pipeline::Impl::add_methods(const PipelineConfig& config) {
  std::vector<std::string> taken{std::string(kSampleSource)};
  const auto check_id = [&taken](const std::string& list, const std::string& id) {
    if (id.empty() || std::find(taken.begin(), taken.end(), id) != taken.end()) {
      throw bad_config("[[" + list + "]] id", "'" + id + "' is empty, taken or reserved",
                       "a name of its own");
    }
    taken.push_back(id);
  };
  std::size_t number = 0;
  for (const EstimatorConfig& each : config.estimators) {
    check_id("estimator", each.id);
    add(number++, each.id, std::make_unique<EstimatorChannel>(each, sample_time_s),
        each.fingerprint());
  }
  std::vector<PendingMethod> pending;
  for (const DetectionMethodList& list : config.methods) {
    for (const auto& item : list.items) {
      check_id(list.kind.list, item->id);
      pending.push_back(
          {number++, "[[" + std::string(list.kind.list) + "]] " + item->id, item.get()});
    }
  }
  const auto is_pending = [&pending](std::string_view id) {
    return std::any_of(pending.begin(), pending.end(),
                       [&](const PendingMethod& each) { return each.config->id == id; });
  };
  while (!pending.empty()) {
    const auto ready = std::find_if(pending.begin(), pending.end(), [&](const PendingMethod& each) {
      const std::vector<std::string> inputs = each.config->inputs();
      return std::none_of(inputs.begin(), inputs.end(), [&](const std::string& input) {
        return is_pending(split_quantity(input).source);
      });
    });
    if (ready == pending.end()) {
      throw bad_config(pending.front().where, "reads a source that reads it in turn");
    }
    std::string settings = ready->config->fingerprint();
    for (const std::string& input : ready->config->inputs()) {
      (void)locate(input, ready->where);
      if (const MethodSlot* read = slot(split_quantity(input).source))
        settings += "|" + read->settings;
    }
    add(ready->number, ready->config->id, ready->config->make({sample_time_s, *this}),
        std::move(settings));
    pending.erase(ready);
  }
}

void Pipeline::Impl::add(std::size_t number, const std::string& id,
                         std::unique_ptr<DetectionMethod> method, std::string settings) {
  MethodSlot slot{
      number, id, std::move(method), std::make_unique<OutputPort>(), std::move(settings), {},
      {},     {}};
  slot.names = slot.method->names();
  slot.monitors.resize(slot.names.size());
  slot.port->interval_s = slot.method->interval_s();
  for (Alarm& alarm : slot.method->declared_alarms()) {
    alarm.source = id;
    alarm.quantity = id + "." + alarm.name;
    alarm.named_at_run_time = alarm.parameter.empty() && alarm.ambiguity_group.empty();
    slot.declared_alarms.push_back(book.declare(alarm));
  }
  slots.push_back(std::move(slot));
  MethodSlot& last = slots.back();
  for (const std::string& name : last.names) {
    last.port->values.push_back({name, kNaN, kNaN, kNaN, kNaN});
  }
}

MethodSlot* Pipeline::Impl::slot(std::string_view id) noexcept {
  for (MethodSlot& each : slots) {
    if (each.id == id) return &each;
  }
  return nullptr;
}

std::pair<std::size_t, std::size_t> Pipeline::Impl::locate(const std::string& quantity,
                                                           const std::string& where) const {
  const auto [source, name] = split_quantity(quantity);
  if (source == kSampleSource) {
    std::vector<std::string> known;
    for (std::size_t i = 0; i < kSampleQuantities.size(); ++i) {
      if (kSampleQuantities[i].name == name) return {slots.size(), i};
      known.emplace_back(kSampleQuantities[i].name);
    }
    throw bad_config(where, "a sample has no " + std::string(name), joined(known));
  }
  std::vector<std::string> ids{std::string(kSampleSource)};
  for (std::size_t i = 0; i < slots.size(); ++i) {
    ids.push_back(slots[i].id);
    if (slots[i].id != source) continue;
    const auto& names = slots[i].names;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return {i, static_cast<std::size_t>(found - names.begin())};
    throw bad_config(where, slots[i].id + " estimates no " + std::string(name), joined(names));
  }
  throw bad_config(where, "'" + quantity + "' names no estimator or other source", joined(ids));
}

MethodInput Pipeline::Impl::find(const std::string& quantity, const std::string& where) const {
  const auto [source, value] = locate(quantity, where);
  return {source < slots.size() ? *slots[source].port : sample, value};
}

void Pipeline::Impl::add(const BandConfig& band) {
  const std::string where = "[[band]] " + band.id;
  check(band, where);
  for (const Alarm& alarm : book.alarms()) {
    if (alarm.name == band.id) throw bad_config(where + ": id", "is taken", "a name of its own");
  }
  const auto [source, value] = locate(band.quantity, where + ": quantity");
  const BandMonitor monitor{BandState(band),
                            book.declare(alarm_for(band, split_quantity(band.quantity).source))};
  if (source == slots.size()) {
    sample_monitors.push_back({value, monitor});
    return;
  }
  MethodSlot& slot = slots[source];
  if (slot.monitors[value].empty()) {
    slot.port->values[value].low = given(band.low);
    slot.port->values[value].high = given(band.high);
  }
  slot.monitors[value].push_back(monitor);
}

}  // namespace estimator::fdi
