#include "hal/rig.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <ranges>
#include <utility>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "hal/comedi/comedi.h"
#include "hal/encoder/encoder.h"
#include "hal/modbus/modbus.h"
#include "hal/replay/replay.h"
#include "hal/sim/sim.h"

namespace hal {
namespace {

using config::schema::bad_config;
using config::schema::wiring;

constexpr const char* kNone = "none";

template <class T>
std::unique_ptr<Backend> make() {
  return std::make_unique<T>();
}

struct Entry {
  const char* name;
  std::unique_ptr<Backend> (*make)();
};

/// All backends.
constexpr Entry kRegistry[] = {
    {"sim", make<sim::SimBackend>},
    {"replay", make<replay::ReplayBackend>},
    {"encoder", make<encoder::EncoderBackend>},
    {"comedi", make<comedi::ComediBackend>},
    {"modbus", make<modbus::ModbusBackend>},
};

constexpr std::pair<const char*, InputRole> kRoles[] = {
    {"e_stop", InputRole::e_stop},
    {"enable", InputRole::enable},
    {"valve_command", InputRole::valve_command},
    {"supply_pressure", InputRole::supply_pressure},
    {"pressure_in", InputRole::pressure_in},
    {"pressure_out", InputRole::pressure_out},
    {"pressure", InputRole::pressure},
    {"other", InputRole::other},
};

InputRole role_of(const std::string& name) {
  for (const auto& [text, role] : kRoles) {
    if (name == text) return role;
  }
  return InputRole::other;
}

void visit_device(config::schema::Visitor& v, DeviceAddress& device, bool channel_required) {
  v.text(wiring({"backend", "one of the backends", true}), device.backend);
  v.text(wiring({"channel", "device of the backend", channel_required}), device.channel);
}

template <class Map>
std::string names_of(const Map& map) {
  return map.empty() ? "none" : config::schema::joined(std::views::keys(map));
}

/// Opens each backend on first use.
class OpenBackends {
 public:
  OpenBackends(const OpenContext& context, std::function<const Backend*(const std::string&)> find)
      : context_(context), find_(std::move(find)) {}

  /// `where`: "[rod]". Throws Error.
  BackendDevices& of(const std::string& where, const std::string& name, const char* more = "") {
    const auto known = opened_.find(name);
    if (known != opened_.end()) return known->second;
    const Backend* backend = find_(name);
    if (backend == nullptr) {
      throw bad_config(context_.file + ": " + where + " backend", "is \"" + name + "\"",
                       backend_names() + more);
    }
    return opened_.emplace(name, backend->open(context_)).first->second;
  }

  /// The device at `device` among the backend's `kind` (BackendDevices::rods, ...). Throws Error.
  template <class Device>
  std::shared_ptr<Device> at(const std::string& where, const DeviceAddress& device,
                             std::map<std::string, std::shared_ptr<Device>> BackendDevices::*kind) {
    const auto& devices = of(where, device.backend).*kind;
    const auto found = devices.find(device.channel);
    if (found == devices.end()) {
      throw bad_config(context_.file + ": " + where + " channel",
                       "is \"" + device.channel + "\", which backend \"" + device.backend +
                           "\" does not offer here",
                       names_of(devices));
    }
    return found->second;
  }

  [[nodiscard]] const std::map<std::string, BackendDevices>& all() const noexcept {
    return opened_;
  }

 private:
  const OpenContext& context_;
  std::function<const Backend*(const std::string&)> find_;
  std::map<std::string, BackendDevices> opened_;
};

std::string indexed(const char* table, std::size_t index) {
  return std::string("[[") + table + "]] " + std::to_string(index + 1);
}

}  // namespace

std::string backend_names() { return config::schema::joined_by(kRegistry, &Entry::name); }

void SpareRodConfig::visit(config::schema::Visitor& v) {
  v.text({"id", "name of the sensor", true}, id);
  visit_device(v, device, false);
}

void InputConfig::visit(config::schema::Visitor& v) {
  v.text({"id", "name of the signal", true}, id);
  v.choice(wiring({"role", "role"}), role,
           {kRoles[0].first, kRoles[1].first, kRoles[2].first, kRoles[3].first, kRoles[4].first,
            kRoles[5].first, kRoles[6].first, kRoles[7].first});
  visit_device(v, device, true);
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

std::vector<std::string> Rig::used() const {
  std::vector<std::string> names{rod_.backend};
  if (valve_.backend != kNone) names.push_back(valve_.backend);
  for (const SpareRodConfig& rod : spare_rods_) names.push_back(rod.device.backend);
  for (const InputConfig& input : inputs_) names.push_back(input.device.backend);
  if (permit_present_) names.push_back(permit_.backend);
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

void Rig::visit(config::schema::Visitor& v) {
  v.table({"rod", "device that reads the rod"},
          [this](config::schema::Visitor& t) { visit_device(t, rod_, false); });
  config::schema::visit_list(v, {"spare_rod", "a further rod sensor"}, spare_rods_);
  v.table({"valve", "device that drives the valve"}, [this](config::schema::Visitor& t) {
    t.text(wiring({"backend", "one of the backends, or none"}), valve_.backend);
    if (valve_.backend == kNone) return;
    t.number({"null_V", "the commanded safe voltage"}, valve_.null_V, {-100.0, 100.0});
    t.number({"limit_V", "greatest distance of a command from null"}, valve_.limit_V,
             {1e-3, 100.0});
    t.number({"slew_V_per_s", "fastest change of a command"}, valve_.slew_V_per_s,
             {1e-3, std::numeric_limits<double>::infinity()});
    t.boolean({"accept_no_hardware_watchdog", "drive the valve without a hardware watchdog"},
              valve_.accept_no_hardware_watchdog);
  });
  config::schema::visit_list(v, {"input", "an auxiliary signal"}, inputs_);
  v.optional_table({"permit", "a line that every good tick toggles, for a watchdog relay"},
                   permit_present_,
                   [this](config::schema::Visitor& t) { visit_device(t, permit_, false); });
  const std::vector<std::string> in_use = used();
  for (std::size_t i = 0; i < backends_.size(); ++i) {
    const char* name = kRegistry[i].name;
    if (std::find(in_use.begin(), in_use.end(), name) == in_use.end()) continue;
    v.table({name, "table of that backend"},
            [&](config::schema::Visitor& t) { backends_[i]->visit(t); });
  }
}

void Rig::check_inputs(const std::string& file) const {
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (inputs_[i].id != inputs_[j].id) continue;
      throw bad_config(file + ": " + indexed("input", i) + " id",
                       "is \"" + inputs_[i].id + "\", and so is that of an earlier one",
                       "an id of its own");
    }
    const auto same = [&](const InputConfig& input) { return input.role == inputs_[i].role; };
    const auto end = inputs_.begin() + static_cast<std::ptrdiff_t>(i);
    const auto first = std::find_if(inputs_.begin(), end, same);
    if (!goes_with_samples(role_of(inputs_[i].role)) || first == end) continue;
    throw bad_config(file + ": " + indexed("input", i) + " role",
                     "is \"" + inputs_[i].role + "\", and so is that of \"" + first->id + "\"",
                     "one input of that role; \"pressure\" for any other");
  }
}

Devices Rig::open(const OpenContext& context) const {
  check_inputs(context.file);
  OpenBackends opened(context, [this](const std::string& name) { return find(name); });
  Devices devices;
  opened.of("[rod]", rod_.backend);
  if (valve_.backend != kNone) {
    const BackendDevices& offered = opened.of("[valve]", valve_.backend, ", none");
    const auto dictates = [](const auto& entry) { return !std::isnan(entry.second.sample_time_s); };
    if (std::any_of(opened.all().begin(), opened.all().end(), dictates)) {
      throw bad_config(context.file + ": [valve] backend",
                       "is \"" + valve_.backend + "\" while a record is replayed", kNone);
    }
    if (offered.valve == nullptr) {
      throw bad_config(context.file + ": [valve] backend",
                       "is \"" + valve_.backend + "\", which drives no valve", "sim, none");
    }
    devices.valve = offered.valve;
  }
  devices.rod = opened.at("[rod]", rod_, &BackendDevices::rods);
  for (std::size_t i = 0; i < spare_rods_.size(); ++i) {
    devices.spare_rods.push_back(
        {spare_rods_[i].id,
         opened.at(indexed("spare_rod", i), spare_rods_[i].device, &BackendDevices::rods)});
  }
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    devices.inputs.push_back(
        {inputs_[i].id, role_of(inputs_[i].role),
         opened.at(indexed("input", i), inputs_[i].device, &BackendDevices::inputs)});
  }
  if (permit_present_) devices.permit = opened.at("[permit]", permit_, &BackendDevices::outputs);
  for (const auto& [name, offered] : opened.all()) {
    if (!std::isnan(offered.sample_time_s)) devices.sample_time_s = offered.sample_time_s;
    devices.fast = devices.fast || offered.fast;
    if (offered.summary) devices.summaries.push_back(offered.summary);
  }
  return devices;
}

std::shared_ptr<ValveDrive> Rig::open_valve(const OpenContext& context) const {
  const Backend* backend = find(valve_.backend);
  if (backend == nullptr || !backend->outlives_process()) return nullptr;
  return backend->open(context).valve;
}

bool Rig::has_input(InputRole role) const {
  return std::any_of(inputs_.begin(), inputs_.end(),
                     [role](const InputConfig& input) { return role_of(input.role) == role; });
}

bool Rig::measures_pressures() const {
  return std::any_of(inputs_.begin(), inputs_.end(), [](const InputConfig& input) {
    return goes_with_samples(role_of(input.role));
  });
}

bool Rig::harmless() const {
  const std::vector<std::string> in_use = used();
  return std::all_of(in_use.begin(), in_use.end(), [this](const std::string& name) {
    const Backend* backend = find(name);
    return backend == nullptr || backend->harmless();
  });
}

double Rig::worst_speed_mps(const OpenContext& context) const {
  const Backend* valve = find(valve_.backend);
  return valve == nullptr ? 0.0 : valve->worst_speed_mps(context, valve_.limit_V);
}

NullTimes Rig::null_times() const {
  const Backend* valve = find(valve_.backend);
  return valve == nullptr ? NullTimes{} : valve->null_times();
}

double Rig::reading_hold_s(const OpenContext& context) const {
  std::vector<std::string> names{rod_.backend};
  for (const SpareRodConfig& spare : spare_rods_) names.push_back(spare.device.backend);
  for (const InputConfig& input : inputs_) {
    const InputRole role = role_of(input.role);
    if (role == InputRole::e_stop || role == InputRole::enable)
      names.push_back(input.device.backend);
  }
  double hold_s = 0.0;
  for (const std::string& name : names) {
    const Backend* backend = find(name);
    if (backend != nullptr) hold_s = std::max(hold_s, backend->reading_hold_s(context));
  }
  return hold_s;
}

std::vector<std::string> Rig::notes(const OpenContext& context) const {
  std::vector<std::string> notes;
  std::string pressures;
  for (const InputConfig& input : inputs_) {
    if (!goes_with_samples(role_of(input.role))) continue;
    pressures += (pressures.empty() ? "" : ", ") + input.role + " from " + input.device.backend +
                 " \"" + input.device.channel + "\"";
  }
  if (!pressures.empty()) notes.push_back("Pressures with every sample: " + pressures + ".");
  for (const std::string& name : used()) {
    const Backend* backend = find(name);
    if (backend == nullptr) continue;
    for (std::string& line : backend->notes(context)) notes.push_back(std::move(line));
  }
  return notes;
}

}  // namespace hal
