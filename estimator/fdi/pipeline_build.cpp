// How a pipeline is put together: sources in the order in which they read each other, then bands.
#include <algorithm>
#include <cmath>
#include <limits>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "estimator/fdi/estimator_source.h"
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

/// A source that waits for those that it reads.
struct Waiting {
  std::size_t number;
  std::string where;  ///< "[[cusum]] id"
  const SourceConfig* config;
};

}  // namespace

Pipeline::Impl::Impl(const PipelineConfig& config, double sample_time)
    : book(sample_time), sample_time_s(sample_time) {
  if (!(sample_time_s > 0.0)) throw bad_config("sample time", "is not positive");
  for (const NamedSampleQuantity& each : kSampleQuantities) {
    sample.values.push_back({each.name, kNan, kNan, kNan, kNan});
  }
  sample.finding.valid = true;
  sample.interval_s = sample_time_s;
  add_sources(config);
  for (const BandConfig& band : config.bands) add(band);
}

void Pipeline::Impl::add_sources(const PipelineConfig& config) {
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
    add(number++, each.id, std::make_unique<EstimatorSource>(each, sample_time_s),
        each.fingerprint());
  }
  std::vector<Waiting> waiting;
  for (const SourceList& list : config.sources) {
    for (const auto& item : list.items) {
      check_id(list.kind.list, item->id);
      waiting.push_back(
          {number++, "[[" + std::string(list.kind.list) + "]] " + item->id, item.get()});
    }
  }
  const auto is_waiting = [&waiting](std::string_view id) {
    return std::any_of(waiting.begin(), waiting.end(),
                       [&](const Waiting& each) { return each.config->id == id; });
  };
  while (!waiting.empty()) {
    const auto ready = std::find_if(waiting.begin(), waiting.end(), [&](const Waiting& each) {
      const std::vector<std::string> inputs = each.config->inputs();
      return std::none_of(inputs.begin(), inputs.end(), [&](const std::string& input) {
        return is_waiting(split_quantity(input).source);
      });
    });
    if (ready == waiting.end()) {
      throw bad_config(waiting.front().where, "reads a source that reads it in turn");
    }
    std::string settings = ready->config->fingerprint();
    for (const std::string& input : ready->config->inputs()) {
      (void)place(input, ready->where);
      if (const Worker* read = worker(split_quantity(input).source))
        settings += "|" + read->settings;
    }
    add(ready->number, ready->config->id, ready->config->make({sample_time_s, *this}),
        std::move(settings));
    waiting.erase(ready);
  }
}

void Pipeline::Impl::add(std::size_t number, const std::string& id, std::unique_ptr<Source> source,
                         std::string settings) {
  Worker worker{number, id, std::move(source), std::make_unique<Outlet>(), std::move(settings), {},
                {},     {}};
  worker.names = worker.source->names();
  worker.watches.resize(worker.names.size());
  worker.outlet->interval_s = worker.source->interval_s();
  for (Alarm& alarm : worker.source->own_alarms()) {
    alarm.source = id;
    alarm.quantity = id + "." + alarm.name;
    alarm.named_at_run_time = alarm.parameter.empty() && alarm.ambiguity_group.empty();
    worker.own_alarms.push_back(book.declare(alarm));
  }
  workers.push_back(std::move(worker));
  Worker& placed = workers.back();
  for (const std::string& name : placed.names) {
    placed.outlet->values.push_back({name, kNan, kNan, kNan, kNan});
  }
}

Worker* Pipeline::Impl::worker(std::string_view id) noexcept {
  for (Worker& each : workers) {
    if (each.id == id) return &each;
  }
  return nullptr;
}

std::pair<std::size_t, std::size_t> Pipeline::Impl::place(const std::string& quantity,
                                                          const std::string& where) const {
  const auto [source, name] = split_quantity(quantity);
  if (source == kSampleSource) {
    std::vector<std::string> known;
    for (std::size_t i = 0; i < kSampleQuantities.size(); ++i) {
      if (kSampleQuantities[i].name == name) return {workers.size(), i};
      known.emplace_back(kSampleQuantities[i].name);
    }
    throw bad_config(where, "a sample has no " + std::string(name), config::schema::joined(known));
  }
  std::vector<std::string> ids{std::string(kSampleSource)};
  for (std::size_t i = 0; i < workers.size(); ++i) {
    ids.push_back(workers[i].id);
    if (workers[i].id != source) continue;
    const auto& names = workers[i].names;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return {i, static_cast<std::size_t>(found - names.begin())};
    throw bad_config(where, workers[i].id + " estimates no " + std::string(name),
                     config::schema::joined(names));
  }
  throw bad_config(where, "'" + quantity + "' names no estimator or other source",
                   config::schema::joined(ids));
}

Input Pipeline::Impl::find(const std::string& quantity, const std::string& where) const {
  const auto [source, value] = place(quantity, where);
  return {source < workers.size() ? *workers[source].outlet : sample, value};
}

void Pipeline::Impl::add(const BandConfig& band) {
  const std::string where = "[[band]] " + band.id;
  check(band, where);
  for (const Alarm& alarm : book.alarms()) {
    if (alarm.name == band.id) throw bad_config(where + ": id", "is taken", "a name of its own");
  }
  const auto [source, value] = place(band.quantity, where + ": quantity");
  const Watch watch{BandState(band),
                    book.declare(alarm_for(band, split_quantity(band.quantity).source))};
  if (source == workers.size()) {
    sample_watches.push_back({value, watch});
    return;
  }
  Worker& worker = workers[source];
  if (worker.watches[value].empty()) {
    worker.outlet->values[value].low = given(band.low);
    worker.outlet->values[value].high = given(band.high);
  }
  worker.watches[value].push_back(watch);
}

}  // namespace estimator::fdi
