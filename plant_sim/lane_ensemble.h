// Implementation of Ensemble: what any machine runs (LaneEnsemble, in ensemble.cpp) and the
// physics at eight lanes (InLanes), compiled once for each instruction set.
//
// A file compiled for a wide instruction set instantiates InLanes and nothing else: it must not
// emit a function that the rest of the program could share with it, which would then run wide
// instructions on a machine without them. So InLanes has no strings, no vectors of common types and
// no exceptions; tests/plant_sim/wide_symbols.py looks at what those files emit.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "plant_sim/ensemble.h"
#include "plant_sim/formula/formula.h"
#include "plant_sim/plants.h"

namespace plant_sim {

class LaneEnsemble : public Ensemble {
 public:
  LaneEnsemble(const formula::Formulas& formulas, double step_s);
  LaneEnsemble(const LaneEnsemble&) = delete;
  LaneEnsemble& operator=(const LaneEnsemble&) = delete;
  ~LaneEnsemble() override;

  /// Sets all lanes to the model's values.
  void take(const ModelFile& model);

  [[nodiscard]] std::optional<std::size_t> find(std::string_view dotted) const final;
  void set(std::size_t parameter, std::size_t lane, double value) noexcept final;
  [[nodiscard]] double get(std::size_t parameter, std::size_t lane) const noexcept final;
  [[nodiscard]] std::optional<std::size_t> find_state(std::string_view name) const final;
  [[nodiscard]] Values state(std::size_t index) const noexcept final;
  void set_state(std::size_t index, const Values& values) noexcept final;

 protected:
  /// Registers eight lanes that live as long as *this; owner is an effect, "initial" or null.
  void enter(const char* owner, const char* name, void* lanes);
  /// The same for an integration state.
  void enter_state(const char* name, void* lanes);
  [[nodiscard]] double step_s() const { return step_s_; }
  void note_change() { changed_ = true; }
  /// True when a parameter has been set since the last call.
  [[nodiscard]] bool takes_changes() { return std::exchange(changed_, false); }
  [[nodiscard]] const formula::Formulas& formulas() const { return formulas_; }

 private:
  struct Entry {
    std::string name;
    void* lanes;
  };
  [[nodiscard]] static std::optional<std::size_t> find_in(const std::vector<Entry>& entries,
                                                          std::string_view name);

  double step_s_;
  bool changed_ = true;
  formula::Formulas formulas_;
  std::vector<Entry> entries_;
  std::vector<Entry> initial_;
  std::vector<Entry> states_;
};

/// A template of physics at eight lanes, behind the runtime face.
template <class Model, class S>
class InLanes final : public LaneEnsemble {
 public:
  InLanes(const formula::Formulas& declared, double step_s) : LaneEnsemble(declared, step_s) {
    model_.effects.formulas().declare(formulas().data(), formulas().size());
    model_.parameters.visit(
        [&](const ParameterInfo& info, S& value) { enter(nullptr, info.name, &value); });
    model_.effects.each([&](auto tag, auto& parameters) {
      using Effect = typename decltype(tag)::Type;
      if constexpr (effects::fits<Effect, Model>()) {
        parameters.visit(
            [&](const ParameterInfo& info, S& value) { enter(Effect::kName, info.name, &value); });
      }
    });
    model_.effects.formulas().each([&](const formula::FormulaView& formula,
                                       const ParameterInfo& info,
                                       S& value) { enter(formula.name, info.name, &value); });
    model_.initial.visit(
        [&](const ParameterInfo& info, S& value) { enter("initial", info.name, &value); });
    const auto enter_one = [&](const char* name, S& value) { enter_state(name, &value); };
    model_.state.visit(enter_one);
    model_.effects.each_memory([&](auto tag, auto& memory) {
      using Effect = typename decltype(tag)::Type;
      if constexpr (effects::fits<Effect, Model>() && requires { memory.visit(enter_one); }) {
        memory.visit(enter_one);
      }
    });
  }

  void start(double reading_m) noexcept override {
    if (takes_changes()) model_.prepare(step_s());
    model_.initial.y_m = reading_m;
    model_.reset();
    const S off_m = model_.effects.reading_m(model_.state.y_m) - reading_m;
    model_.state.y_m -= off_m;
  }

  void advance(const Values& u_V, double duration_s) noexcept override {
    if (takes_changes()) model_.prepare(step_s());
    const S u = S::load(u_V.data());
    const auto steps = ::llround(duration_s / step_s());
    for (long long i = 0; i < steps; ++i) model_.step(u);
  }
  void disturb(const Values& force_N) noexcept override {
    if constexpr (requires { model_.disturbance_N; }) {
      model_.disturbance_N = S::load(force_N.data());
    }
  }
  void place_disturbance(double place) noexcept override {
    if constexpr (requires { model_.disturbance_place; }) {
      if (all(model_.disturbance_place <= S(place)) && all(model_.disturbance_place >= S(place)))
        return;
      model_.disturbance_place = place;
      note_change();
    }
  }
  void shift(const Values& by_m) noexcept override { model_.state.y_m += S::load(by_m.data()); }

  [[nodiscard]] Values reading_m() const noexcept override {
    return unpack(model_.effects.reading_m(model_.state.y_m));
  }
  [[nodiscard]] Values speed_mps() const noexcept override { return unpack(model_.speed_mps()); }
  [[nodiscard]] PressuresOf<Values> pressures() const noexcept override {
    const PressuresOf<S> p = pressures_of<S>(model_);
    return {unpack(p.supply_Pa), unpack(p.in_Pa), unpack(p.out_Pa)};
  }

 private:
  static Values unpack(const S& lanes) {
    Values values;
    lanes.store(values.data());
    return values;
  }

  Model model_;
};

/// The named plant at eight lanes, owned by the caller; null for an unknown name.
template <class S>
LaneEnsemble* new_lanes(const char* plant, const formula::Formulas& formulas, double step_s) {
  LaneEnsemble* made = nullptr;
  each_plant<S>([&]<class Model>() {
    if (__builtin_strcmp(plant, Model::kName) == 0) made = new InLanes<Model, S>(formulas, step_s);
  });
  return made;
}

LaneEnsemble* new_avx2_lanes(const char* plant, const formula::Formulas& formulas, double step_s);
LaneEnsemble* new_avx512_lanes(const char* plant, const formula::Formulas& formulas, double step_s);

}  // namespace plant_sim
