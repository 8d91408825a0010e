#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/pipeline_impl.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_config;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double given(double limit) noexcept { return std::isinf(limit) ? kNan : limit; }

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

}  // namespace

double EstimateEvent::value(std::string_view name) const noexcept {
  for (const NamedValue& v : *this) {
    if (v.name == name) return v.value;
  }
  return kNan;
}

Pipeline::Impl::Impl(const PipelineConfig& config, double sample_time)
    : book(sample_time), sample_time_s(sample_time) {
  if (!(sample_time_s > 0.0)) throw bad_config("sample time", "is not positive");
  workers.reserve(config.estimators.size());
  for (const EstimatorConfig& estimator : config.estimators) add(estimator);
  for (const BandConfig& band : config.bands) add(band);
}

void Pipeline::Impl::add(const EstimatorConfig& config) {
  if (config.id.empty() || config.id == kSampleSource ||
      std::find(ids.begin(), ids.end(), config.id) != ids.end()) {
    throw bad_config("[[estimator]] id", "'" + config.id + "' is empty, taken or reserved",
                     "a name of its own");
  }
  ids.push_back(config.id);
  Worker worker{Stage(config, sample_time_s), config.fingerprint(), {}, {}, {}};
  worker.names = estimate_names(worker.stage.structure());
  worker.watches.resize(worker.names.size());
  workers.push_back(std::move(worker));
  Worker& placed = workers.back();
  for (const std::string& name : placed.names) {
    placed.values.push_back({name, kNan, kNan, kNan, kNan});
  }
}

void Pipeline::Impl::add(const BandConfig& band) {
  const std::string where = "[[band]] " + band.id;
  check(band, where);
  for (const Alarm& alarm : book.alarms()) {
    if (alarm.name == band.id) throw bad_config(where + ": id", "is taken", "a name of its own");
  }
  const auto [source, name] = split_quantity(band.quantity);
  if (source == kSampleSource) {
    const SampleQuantity quantity = parse_sample_quantity(name, where + ": quantity");
    sample_watches.push_back({quantity, {BandState(band), book.declare(alarm_for(band, source))}});
    return;
  }
  const auto id = std::find(ids.begin(), ids.end(), source);
  if (id == ids.end()) {
    std::string known(kSampleSource);
    for (const std::string& each : ids) known += ", " + each;
    throw bad_config(where + ": quantity", "'" + band.quantity + "' names no estimator", known);
  }
  Worker& worker = workers[static_cast<std::size_t>(id - ids.begin())];
  const auto found = std::find(worker.names.begin(), worker.names.end(), name);
  if (found == worker.names.end()) {
    std::string known;
    for (const std::string& each : worker.names) known += (known.empty() ? "" : ", ") + each;
    throw bad_config(where + ": quantity", *id + " estimates no " + std::string(name), known);
  }
  const auto index = static_cast<std::size_t>(found - worker.names.begin());
  if (worker.watches[index].empty()) {
    worker.values[index].low = given(band.low);
    worker.values[index].high = given(band.high);
  }
  worker.watches[index].push_back({BandState(band), book.declare(alarm_for(band, source))});
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
  char text[160] = "";
  if (alarm.severity != state.severity || alarm.direction != state.direction) {
    if (result.severity == Severity::invalid) {
      std::snprintf(text, sizeof text, "%s cannot be trusted: %s", alarm.quantity.c_str(),
                    reading.why);
    } else if (result.direction != 0) {
      std::snprintf(text, sizeof text, "%s is %.6g, %s %.6g", alarm.quantity.c_str(), reading.value,
                    result.direction > 0 ? "above" : "below",
                    result.direction > 0 ? alarm.high : alarm.low);
    } else {
      std::snprintf(text, sizeof text, "%s is %.6g, inside its band", alarm.quantity.c_str(),
                    reading.value);
    }
  }
  state.reason = text;
  if (const Alarm* changed = book.set(watch.alarm, state)) events.on_alarm(*changed);
}

void Pipeline::Impl::emit(std::size_t number, std::int64_t tick, std::int64_t utc_us,
                          Events& events) {
  Worker& worker = workers[number];
  const Estimate found = worker.stage.estimate();
  const int size = worker.stage.structure().size();
  for (int i = 0; i < size; ++i) {
    worker.values[i].value = i < found.size ? found.value[i] : kNan;
    worker.values[i].std_error = i < found.size ? found.std_error[i] : kNan;
  }
  worker.values[size].value = found.residual_rms_m;
  worker.values[size + 1].value = found.condition;
  const bool warming_up = worker.stage.warming_up();
  events.on_estimate({number, ids[number], tick, utc_us, found.valid, warming_up,
                      text(found.reason), found.condition, found.samples, worker.values.data(),
                      worker.values.data() + worker.values.size()});
  if (warming_up) return;
  for (std::size_t i = 0; i < worker.values.size(); ++i) {
    const NamedValue& value = worker.values[i];
    for (Watch& watch : worker.watches[i]) {
      judge(watch, {value.value, value.std_error, found.valid, text(found.reason), tick}, events);
    }
  }
}

Pipeline::Pipeline(const PipelineConfig& config, double sample_time_s)
    : impl_(std::make_unique<Impl>(config, sample_time_s)) {}
Pipeline::~Pipeline() = default;
Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;

void Pipeline::process(const Sample& sample, Events& events) {
  Impl& impl = *impl_;
  std::int64_t lost = 0;
  if (impl.started && sample.tick <= impl.last_tick) {
    for (Worker& worker : impl.workers) worker.stage.reset();
  } else if (impl.started) {
    lost = std::max<std::int64_t>(sample.gap, sample.tick - impl.last_tick - 1);
  }
  impl.started = true;
  impl.last_tick = sample.tick;
  impl.book.advance(sample.tick, sample.utc_us,
                    [&events](const Alarm& alarm) { events.on_alarm(alarm); });
  const double y_m = usable_y_m(sample);
  for (std::size_t i = 0; i < impl.workers.size(); ++i) {
    Stage& stage = impl.workers[i].stage;
    if (lost > 0 && stage.lose(lost)) impl.emit(i, sample.tick - 1, sample.utc_us, events);
    if (stage.push(sample.u_applied_V, y_m, sample.saturated)) {
      impl.emit(i, sample.tick, sample.utc_us, events);
    }
  }
  for (SampleWatch& watched : impl.sample_watches) {
    const double value = value_of(watched.quantity, sample);
    impl.judge(watched.watch, {value, kNan, std::isfinite(value), "no good reading", sample.tick},
               events);
  }
}

void Pipeline::reset() {
  impl_->started = false;
  for (Worker& worker : impl_->workers) worker.stage.reset();
  impl_->for_each_watch([](Watch& watch) { watch.state.reset(); });
  impl_->book.reset();
}

AlarmBook& Pipeline::alarms() noexcept { return impl_->book; }
const AlarmBook& Pipeline::alarms() const noexcept { return impl_->book; }

}  // namespace estimator::fdi
