#include "plant_sim/plant.h"

#include <cmath>

#include "config/schema/error.h"
#include "plant_sim/library.h"
#include "plant_sim/plants.h"
#include "plant_sim/pressures.h"

namespace plant_sim {
namespace {

/// A template of physics at one double, behind the runtime face.
template <class Model>
class Simulated final : public Plant {
 public:
  explicit Simulated(const ModelFile& file) : step_s_(file.step_s), formulas_(file.formulas()) {
    model_.effects.formulas().declare(formulas_.data(), formulas_.size());
    each_parameter([&](const std::string& name, const ParameterInfo& info, double& value) {
      infos_.push_back({name, info, &value});
    });
    for (const NamedValue& given : file.parameters) assign(given.name, given.value);
    for (const ModelFile::Effect& effect : file.effects) {
      if (!effect.present) continue;
      for (const NamedValue& given : effect.parameters) {
        assign(effect.name + "." + given.name, given.value);
      }
    }
    for (const NamedValue& given : file.initial) {
      model_.initial.visit([&](const ParameterInfo& info, double& value) {
        if (given.name == info.name) value = given.value;
      });
    }
    model_.prepare(step_s_);
    model_.reset();
  }

  void reset() noexcept override { model_.reset(); }

  void advance(double u_V, double duration_s) noexcept override {
    model_.prepare(step_s_);
    const auto steps = std::llround(duration_s / step_s_);
    for (long long i = 0; i < steps; ++i) model_.step(u_V);
  }

  [[nodiscard]] double position_m() const noexcept override { return model_.state.y_m; }
  [[nodiscard]] double reading_m() const noexcept override {
    return model_.effects.reading_m(model_.state.y_m);
  }
  [[nodiscard]] double speed_mps() const noexcept override { return model_.speed_mps(); }
  [[nodiscard]] config::signals::Pressures pressures() const noexcept override {
    const PressuresOf<double> p = pressures_of<double>(model_);
    return {p.supply_Pa, p.in_Pa, p.out_Pa};
  }
  [[nodiscard]] double step_s() const noexcept override { return step_s_; }

  double* parameter(std::string_view dotted) noexcept override {
    const Entry* found = find(dotted);
    return found == nullptr ? nullptr : found->value;
  }

  [[nodiscard]] const ParameterInfo* parameter_info(
      std::string_view dotted) const noexcept override {
    const Entry* found = find(dotted);
    return found == nullptr ? nullptr : &found->info;
  }

  [[nodiscard]] std::vector<std::string> parameter_names() const override {
    std::vector<std::string> names;
    for (const Entry& entry : infos_) names.push_back(entry.name);
    return names;
  }

  [[nodiscard]] std::vector<NamedValue> state() const override {
    std::vector<NamedValue> values;
    auto copy = model_.state;
    copy.visit([&](const char* name, double value) { values.push_back({name, value}); });
    return values;
  }

  void set_state(std::span<const double> values) noexcept override {
    std::size_t i = 0;
    model_.state.visit([&](const char*, double& value) {
      if (i < values.size()) value = values[i];
      ++i;
    });
  }

 private:
  struct Entry {
    std::string name;
    ParameterInfo info;
    double* value;
  };

  [[nodiscard]] const Entry* find(std::string_view dotted) const {
    const std::string name = library_name(dotted);
    for (const Entry& entry : infos_) {
      if (entry.name == name) return &entry;
    }
    return nullptr;
  }

  template <class F>
  void each_parameter(F&& f) {
    model_.parameters.visit(
        [&](const ParameterInfo& info, double& value) { f(info.name, info, value); });
    model_.effects.each([&](auto tag, auto& parameters) {
      using Effect = typename decltype(tag)::Type;
      if constexpr (effects::fits<Effect, Model>()) {
        parameters.visit([&](const ParameterInfo& info, double& value) {
          f(std::string(Effect::kName) + "." + info.name, info, value);
        });
      }
    });
    model_.effects.formulas().each(
        [&](const formula::FormulaView& formula, const ParameterInfo& info, double& value) {
          f(std::string(formula.name) + "." + info.name, info, value);
        });
  }

  void assign(std::string_view name, double value) noexcept {
    if (double* target = parameter(name)) *target = value;
  }

  double step_s_;
  formula::Formulas formulas_;
  Model model_;
  std::vector<Entry> infos_;
};

}  // namespace

std::unique_ptr<Plant> make_plant(const ModelFile& model) {
  std::unique_ptr<Plant> plant;
  std::string names;
  require_fit(model, model.name);
  require_constant(model);
  each_plant<double>([&]<class Model>() {
    if (model.plant == Model::kName) plant = std::make_unique<Simulated<Model>>(model);
    names += (names.empty() ? "" : ", ") + std::string(Model::kName);
  });
  if (plant == nullptr) {
    throw config::schema::bad_config(model.name, "there is no plant " + model.plant, names);
  }
  return plant;
}

}  // namespace plant_sim
