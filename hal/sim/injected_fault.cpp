#include "hal/sim/injected_fault.h"

#include <algorithm>
#include <iterator>

namespace hal::sim {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

template <class Belongs>
std::vector<InjectedFault> those(const std::vector<InjectedFault>& all, Belongs belongs) {
  std::vector<InjectedFault> chosen;
  std::copy_if(all.begin(), all.end(), std::back_inserter(chosen), belongs);
  return chosen;
}

}  // namespace

void InjectedFault::visit(config::schema::Visitor& v) {
  v.choice({"kind", "kind of fault", true}, kind,
           {"missing", "frozen", "jump", "drift", "stale", "deaf"});
  if (kind != "deaf") v.text({"rod", "id of a spare rod sensor; empty: the rig's own"}, rod);
  if (kind == "missing" || kind == "frozen" || kind == "stale") {
    v.text({"pressure", "pressure transducer, in place of a rod sensor"}, pressure);
  }
  v.number({"from_s", "start time"}, from_s, {0.0, kInfinite});
  v.number({"to_s", "end time"}, to_s, {0.0, kInfinite});
  if (kind == "jump") v.number({"size_m", "added to the reading"}, size_m, {-100.0, 100.0});
  if (kind == "drift") v.number({"rate_mps", "drift of the reading"}, rate_mps, {-1.0, 1.0});
}

void ScheduledFaults::look_up(double t_s) noexcept {
  on_.clear();
  since_s_ = t_s;
  until_s_ = kInfinite;
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const InjectedFault& fault = faults_[i];
    if (fault.at(t_s)) on_.push_back(i);
    for (const double change_s : {fault.from_s, fault.to_s}) {
      if (change_s > t_s) until_s_ = std::min(until_s_, change_s);
    }
  }
}

FaultyRod::FaultyRod(const std::vector<InjectedFault>& all, const std::string& id)
    : faults_(those(all, [&id](const InjectedFault& fault) {
        return fault.rod == id && fault.pressure.empty();
      })) {}

bool FaultyRod::apply(Reading& reading, double t_s) noexcept {
  const double y_m = reading.y_m;
  bool frozen = false;
  bool valve_unresponsive = false;
  faults_.for_each(t_s, [&](const InjectedFault& fault) {
    if (fault.kind == "missing") {
      reading.y_m = kMissing;
      reading.quality = config::signals::Quality::bad;
    } else if (fault.kind == "frozen") {
      reading.y_m = last_y_m_;
      frozen = true;
    } else if (fault.kind == "jump") {
      reading.y_m += fault.size_m;
    } else if (fault.kind == "drift") {
      reading.y_m += fault.rate_mps * (t_s - fault.from_s);
    } else if (fault.kind == "stale") {
      reading.y_m = last_y_m_;
      reading.quality = config::signals::Quality::stale;
      frozen = true;
    } else {
      valve_unresponsive = true;
    }
  });
  if (!frozen) last_y_m_ = y_m;
  return valve_unresponsive;
}

FaultyPressure::FaultyPressure(const std::vector<InjectedFault>& all, const std::string& id)
    : faults_(those(all, [&id](const InjectedFault& fault) { return fault.pressure == id; })) {}

void FaultyPressure::apply(InputReading& reading, double t_s) noexcept {
  const double value_Pa = reading.value;
  bool frozen = false;
  faults_.for_each(t_s, [&](const InjectedFault& fault) {
    if (fault.kind == "missing") {
      reading = {};
      return;
    }
    frozen = true;
    reading.value = last_Pa_;
    if (fault.kind == "stale") reading.quality = config::signals::Quality::stale;
  });
  if (!frozen) last_Pa_ = value_Pa;
}

void SpareConfig::visit(config::schema::Visitor& v) {
  v.text({"id", "name of the channel", true}, id);
  v.number({"offset_m", "added to the position"}, offset_m, {-100.0, 100.0});
  v.number({"from_s", "start time"}, from_s, {0.0, kInfinite});
  v.number({"encoder_resolution_m", "resolution; 0: none"}, encoder_resolution_m, {0.0, 1e-2});
  v.number({"noise_m", "standard deviation of the noise"}, noise_m, {0.0, 1e-2});
}

void SimSwitchConfig::visit(config::schema::Visitor& v) {
  v.text({"id", "name of the channel", true}, id);
  v.number({"value", "reading"}, value, {-1e12, 1e12});
  v.number({"from_s", "start time"}, from_s, {0.0, kInfinite});
  v.number({"to_s", "end time"}, to_s, {0.0, kInfinite});
  v.number({"meanwhile", "reading in between"}, meanwhile, {-1e12, 1e12});
  v.boolean({"missing", "or nothing"}, missing);
}

InputReading Switch::read(const Tick& tick) noexcept {
  const double t_s = static_cast<double>(tick.nominal_ns) * 1e-9;
  const bool now = t_s >= from_s_ && t_s < to_s_;
  if (now && missing_) return {};
  return {now ? meanwhile_ : value_, 0, config::signals::Quality::good};
}

}  // namespace hal::sim
