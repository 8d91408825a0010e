#include "plant_sim/ensemble.h"

#include <cstring>

#include "config/schema/error.h"
#include "plant_sim/lane_ensemble.h"
#include "plant_sim/library.h"

namespace plant_sim {
namespace {

std::unique_ptr<LaneEnsemble> made(const ModelFile& model, double step_s, InstructionSet set) {
  const char* plant = model.plant.c_str();
  const formula::Formulas formulas = model.formulas();
  LaneEnsemble* lanes = nullptr;
  switch (set) {
#ifdef PLANT_SIM_WIDE_LANES
    case InstructionSet::avx512:
      lanes = new_avx512_lanes(plant, formulas, step_s);
      break;
    case InstructionSet::avx2:
      lanes = new_avx2_lanes(plant, formulas, step_s);
      break;
#endif
    default:
      lanes = new_lanes<Simd>(plant, formulas, step_s);
      break;
  }
  return std::unique_ptr<LaneEnsemble>(lanes);
}

}  // namespace

Ensemble::~Ensemble() = default;

bool runs_here(InstructionSet set) noexcept {
  switch (set) {
    case InstructionSet::baseline:
      return true;
#ifdef PLANT_SIM_WIDE_LANES
    case InstructionSet::avx2:
      return __builtin_cpu_supports("avx2") != 0;
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") != 0;
#endif
    default:
      return false;
  }
}

InstructionSet fastest_here() noexcept {
  static const InstructionSet fastest = [] {
    for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2}) {
      if (runs_here(set)) return set;
    }
    return InstructionSet::baseline;
  }();
  return fastest;
}

LaneEnsemble::LaneEnsemble(const formula::Formulas& formulas, double step_s)
    : step_s_(step_s), formulas_(formulas) {}
LaneEnsemble::~LaneEnsemble() = default;

void LaneEnsemble::enter(const char* owner, const char* name, void* lanes) {
  if (owner == nullptr) {
    entries_.push_back({name, lanes});
  } else if (std::strcmp(owner, "initial") == 0) {
    initial_.push_back({name, lanes});
  } else {
    entries_.push_back({std::string(owner) + "." + name, lanes});
  }
}

void LaneEnsemble::enter_state(const char* name, void* lanes) { states_.push_back({name, lanes}); }

void LaneEnsemble::take(const ModelFile& model) {
  const auto assign = [](const std::vector<Entry>& to, const std::string& name, double value) {
    Values every;
    every.fill(value);
    for (const Entry& entry : to) {
      if (entry.name == name) std::memcpy(entry.lanes, every.data(), sizeof(every));
    }
  };
  changed_ = true;
  for (const NamedValue& given : model.parameters) assign(entries_, given.name, given.value);
  for (const ModelFile::Effect& effect : model.effects) {
    if (!effect.present) continue;
    for (const NamedValue& given : effect.parameters) {
      assign(entries_, effect.name + "." + given.name, given.value);
    }
  }
  for (const NamedValue& given : model.initial) assign(initial_, given.name, given.value);
}

std::optional<std::size_t> LaneEnsemble::find_in(const std::vector<Entry>& entries,
                                                 std::string_view name) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].name == name) return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> LaneEnsemble::find(std::string_view dotted) const {
  return find_in(entries_, dotted);
}

std::optional<std::size_t> LaneEnsemble::find_state(std::string_view name) const {
  return find_in(states_, name);
}

Ensemble::Values LaneEnsemble::state(std::size_t index) const noexcept {
  Values values;
  std::memcpy(values.data(), states_[index].lanes, sizeof(values));
  return values;
}

void LaneEnsemble::set_state(std::size_t index, const Values& values) noexcept {
  std::memcpy(states_[index].lanes, values.data(), sizeof(values));
}

void LaneEnsemble::set(std::size_t parameter, std::size_t lane, double value) noexcept {
  std::memcpy(static_cast<char*>(entries_[parameter].lanes) + lane * sizeof(double), &value,
              sizeof(double));
  changed_ = true;
}

double LaneEnsemble::get(std::size_t parameter, std::size_t lane) const noexcept {
  double value = 0.0;
  std::memcpy(&value, static_cast<const char*>(entries_[parameter].lanes) + lane * sizeof(double),
              sizeof(double));
  return value;
}

std::unique_ptr<Ensemble> make_ensemble(const ModelFile& model, double step_s) {
  return make_ensemble(model, step_s, fastest_here());
}

std::unique_ptr<Ensemble> make_ensemble(const ModelFile& model, double step_s, InstructionSet set) {
  require_fit(model, model.name);
  std::unique_ptr<LaneEnsemble> ensemble = made(model, step_s, set);
  if (ensemble == nullptr) {
    throw config::schema::bad_config(model.name, "there is no plant " + model.plant);
  }
  ensemble->take(model);
  return ensemble;
}

}  // namespace plant_sim
