// A pipeline from its configuration: methods in order of evaluation, alarms, bands.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "estimator/fdi/estimator_channel.h"
#include "estimator/fdi/pipeline_impl.h"

namespace estimator::fdi {
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
