#include "plant_sim/ensemble.h"

#include <cmath>
#include <string>
#include <vector>

#include "config/schema/error.h"
#include "plant_sim/library.h"
#include "plant_sim/plants.h"

namespace plant_sim {
namespace {

Lanes pack(const Ensemble::Values& values) {
  Lanes lanes;
  for (std::size_t i = 0; i < Ensemble::kLanes; ++i) lanes.set(i, values[i]);
  return lanes;
}

Ensemble::Values unpack(const Lanes& lanes) {
  Ensemble::Values values;
  for (std::size_t i = 0; i < Ensemble::kLanes; ++i) values[i] = lanes[i];
  return values;
}

/// A template of physics at eight lanes, behind the runtime face.
template <class Model>
class InLanes final : public Ensemble {
 public:
  InLanes(const ModelFile& file, double step_s) : step_s_(step_s) {
    model_.parameters.visit(
        [&](const ParameterInfo& info, Lanes& value) { entries_.push_back({info.name, &value}); });
    model_.effects.each([&](auto tag, auto& parameters) {
      using Effect = typename decltype(tag)::Type;
      if constexpr (fits<Effect, Model>()) {
        parameters.visit([&](const ParameterInfo& info, Lanes& value) {
          entries_.push_back({std::string(Effect::kName) + "." + info.name, &value});
        });
      }
    });
    for (const NamedValue& given : file.parameters) assign(given.name, given.value);
    for (const ModelFile::Effect& effect : file.effects) {
      if (!effect.present) continue;
      for (const NamedValue& given : effect.parameters) {
        assign(effect.name + "." + given.name, given.value);
      }
    }
    for (const NamedValue& given : file.initial) {
      model_.initial.visit([&](const ParameterInfo& info, Lanes& value) {
        if (given.name == info.name) value = given.value;
      });
    }
  }

  [[nodiscard]] std::optional<std::size_t> find(std::string_view dotted) const override {
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (entries_[i].name == dotted) return i;
    }
    return std::nullopt;
  }
  void set(std::size_t parameter, std::size_t lane, double value) noexcept override {
    entries_[parameter].value->set(lane, value);
  }
  [[nodiscard]] double get(std::size_t parameter, std::size_t lane) const noexcept override {
    return (*entries_[parameter].value)[lane];
  }

  void start(double reading_m) noexcept override {
    model_.prepare(step_s_);
    model_.initial.y_m = reading_m;
    model_.reset();
    const Lanes off_m = model_.effects.reading_m(model_.state.y_m) - reading_m;
    model_.state.y_m -= off_m;
  }

  void advance(const Values& u_V, double duration_s) noexcept override {
    model_.prepare(step_s_);
    const Lanes u = pack(u_V);
    const auto steps = std::llround(duration_s / step_s_);
    for (long long i = 0; i < steps; ++i) model_.step(u);
  }
  void shift(const Values& by_m) noexcept override { model_.state.y_m += pack(by_m); }

  [[nodiscard]] Values reading_m() const noexcept override {
    return unpack(model_.effects.reading_m(model_.state.y_m));
  }
  [[nodiscard]] Values speed_mps() const noexcept override { return unpack(model_.speed_mps()); }

 private:
  struct Entry {
    std::string name;
    Lanes* value;
  };

  void assign(const std::string& name, double value) {
    if (const auto found = find(name)) *entries_[*found].value = value;
  }

  double step_s_;
  Model model_;
  std::vector<Entry> entries_;
};

}  // namespace

std::unique_ptr<Ensemble> make_ensemble(const ModelFile& model, double step_s) {
  const PlantInfo* info = find_plant(model.plant);
  std::unique_ptr<Ensemble> ensemble;
  if (info != nullptr) {
    for (const ModelFile::Effect& effect : model.effects) {
      if (effect.present) require_fit(*find_effect(effect.name), *info, model.name);
    }
  }
  each_plant<Lanes>([&]<class Model>() {
    if (model.plant == Model::kName) ensemble = std::make_unique<InLanes<Model>>(model, step_s);
  });
  if (ensemble == nullptr) {
    throw config::schema::bad_config(model.name, "there is no plant " + model.plant);
  }
  return ensemble;
}

}  // namespace plant_sim
