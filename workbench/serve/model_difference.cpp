#include "workbench/serve/model_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/units/quantity.h"
#include "plant_sim/library.h"

namespace workbench::serve {
namespace {

using plant_sim::ModelFile;
using plant_sim::NamedValue;

struct Value {
  std::string name;
  double value = 0.0;
  bool neutral = false;  ///< as if its effect were absent
};

std::vector<Value> values_of(const ModelFile& model) {
  std::vector<Value> values;
  for (const NamedValue& one : model.parameters) values.push_back({one.name, one.value, false});
  const std::vector<plant_sim::EffectInfo> effects = plant_sim::effects_of(model);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    if (!model.effects[i].present) continue;
    for (std::size_t k = 0; k < effects[i].parameters.size(); ++k) {
      const NamedValue& one = model.effects[i].parameters[k];
      values.push_back({effects[i].name + "." + one.name, one.value,
                        one.value == effects[i].parameters[k].neutral});
    }
  }
  return values;
}

std::string words_of(const std::string& name, double value) {
  return config::units::words(config::units::quantity(name, value, std::nan("")));
}

/// In SI, where three digits show no difference.
std::string exactly(double value) { return fmt::format("{:.9g}", value); }

}  // namespace

std::vector<ModelDifference> differences(const ModelFile& here, const ModelFile& there) {
  std::vector<ModelDifference> found;
  if (here.plant != there.plant) found.push_back({"plant", here.plant, there.plant});
  if (here.rotary() != there.rotary()) {
    const auto motion = [](const ModelFile& model) { return model.rotary() ? "rotary" : "linear"; };
    found.push_back({"motion", motion(here), motion(there)});
  }
  std::vector<Value> rest = values_of(there);
  for (const Value& mine : values_of(here)) {
    const auto other = std::find_if(rest.begin(), rest.end(),
                                    [&](const Value& one) { return one.name == mine.name; });
    if (other == rest.end()) {
      if (!mine.neutral) found.push_back({mine.name, words_of(mine.name, mine.value), "-"});
      continue;
    }
    const bool same =
        other->value == mine.value || (std::isnan(other->value) && std::isnan(mine.value));
    if (!same) {
      ModelDifference one{mine.name, words_of(mine.name, mine.value),
                          words_of(mine.name, other->value)};
      if (one.here == one.there) {
        one.here = exactly(mine.value);
        one.there = exactly(other->value);
      }
      found.push_back(std::move(one));
    }
    rest.erase(other);
  }
  for (const Value& one : rest) {
    if (!one.neutral) found.push_back({one.name, "-", words_of(one.name, one.value)});
  }
  return found;
}

}  // namespace workbench::serve
