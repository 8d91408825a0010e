#include "hal/rig.h"

#include <cmath>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "hal/replay/replay.h"
#include "hal/sim/sim.h"

namespace hal {
namespace {

constexpr const char* kNone = "none";

template <class T>
std::unique_ptr<Backend> make() {
  return std::make_unique<T>();
}

struct Entry {
  const char* name;
  std::unique_ptr<Backend> (*make)();
};

/// Every backend there is, one line each.
constexpr Entry kRegistry[] = {
    {"sim", make<sim::SimBackend>},
    {"replay", make<replay::ReplayBackend>},
};

}  // namespace

std::string backend_names() {
  std::string names;
  for (const Entry& entry : kRegistry)
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  return names;
}

Rig::Rig() {
  for (const Entry& entry : kRegistry) backends_.push_back(entry.make());
}

const Backend* Rig::find(const std::string& name) const noexcept {
  for (std::size_t i = 0; i < backends_.size(); ++i) {
    if (name == kRegistry[i].name) return backends_[i].get();
  }
  return nullptr;
}

void Rig::visit(config::schema::Visitor& v) {
  v.table({"rod", "what reads the rod"}, [this](config::schema::Visitor& t) {
    t.text({"backend", "one of the backends", true}, rod_);
  });
  v.table({"valve", "what drives the valve"}, [this](config::schema::Visitor& t) {
    t.text({"backend", "one of the backends, or none"}, valve_.backend);
    if (valve_.backend == kNone) return;
    t.number({"null_V", "the commanded safe voltage"}, valve_.null_V, {-100.0, 100.0});
    t.number({"limit_V", "greatest distance of a command from null"}, valve_.limit_V,
             {1e-3, 100.0});
    t.number({"slew_V_per_s", "fastest change of a command"}, valve_.slew_V_per_s,
             {1e-3, std::numeric_limits<double>::infinity()});
  });
  for (std::size_t i = 0; i < backends_.size(); ++i) {
    const char* name = kRegistry[i].name;
    if (rod_ != name && valve_.backend != name) continue;
    v.table({name, "table of that backend"},
            [&](config::schema::Visitor& t) { backends_[i]->visit(t); });
  }
}

Devices Rig::open(const Opening& opening) const {
  using config::schema::bad_config;
  const Backend* rod = find(rod_);
  if (rod == nullptr) {
    throw bad_config(opening.file + ": [rod] backend", "is \"" + rod_ + "\"", backend_names());
  }
  const std::string valve_key = opening.file + ": [valve] backend";
  const Backend* valve = find(valve_.backend);
  if (valve == nullptr && valve_.backend != kNone) {
    throw bad_config(valve_key, "is \"" + valve_.backend + "\"", backend_names() + ", none");
  }
  Devices devices = rod->open(opening);
  if (valve == nullptr) {
    devices.valve = nullptr;
  } else if (!std::isnan(devices.sample_time_s)) {
    throw bad_config(valve_key, "is \"" + valve_.backend + "\" while a record is replayed", kNone);
  } else if (valve != rod) {
    devices.valve = valve->open(opening).valve;
  }
  if (valve != nullptr && devices.valve == nullptr) {
    throw bad_config(valve_key, "is \"" + valve_.backend + "\", which drives no valve",
                     "sim, none");
  }
  return devices;
}

bool Rig::harmless() const {
  const Backend* rod = find(rod_);
  const Backend* valve = find(valve_.backend);
  return (rod == nullptr || rod->harmless()) && (valve == nullptr || valve->harmless());
}

double Rig::worst_speed_mps(const Opening& opening) const {
  const Backend* valve = find(valve_.backend);
  return valve == nullptr ? 0.0 : valve->worst_speed_mps(opening, valve_.limit_V);
}

}  // namespace hal
