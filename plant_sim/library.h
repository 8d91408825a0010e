// Catalogue of plants and effects with their parameters. For reading model
// files, for the engineer's listing, and for tests that must hold for every effect.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "plant_sim/parameter.h"

namespace plant_sim {

struct ModelFile;

struct EffectInfo {
  std::string name;
  std::string equation;
  std::vector<std::string> sites;  ///< where it attaches (effects/site.h)
  bool dissipative;                ///< can only take energy out
  std::vector<ParameterInfo> parameters;
  std::string what = {};  ///< for a formula of the model file: its stated meaning
};

struct PlantInfo {
  std::string name;
  std::vector<std::string> sites;  ///< where effects can attach (effects/site.h)
  std::vector<ParameterInfo> parameters;
  std::vector<ParameterInfo> initial;  ///< neutral = default; NaN = the plant's own choice
};

/// A name that files and options may use for an effect of the library; none prints it.
struct FurtherName {
  const char* further;
  const char* name;
};

[[nodiscard]] const std::vector<EffectInfo>& effect_library();
[[nodiscard]] const std::vector<FurtherName>& further_names();
[[nodiscard]] const std::vector<PlantInfo>& plant_library();
/// Null for an unknown name.
[[nodiscard]] const PlantInfo* find_plant(std::string_view name);
/// The library's name of an effect, or of one of its parameters: "coupled_slaves.mass_kg" for
/// "added_load.mass_kg". Other names stay as they are.
[[nodiscard]] std::string library_name(std::string_view dotted);
/// Null for an unknown name; further names are known.
[[nodiscard]] const EffectInfo* find_effect(std::string_view name);

/// Every effect that a model can have: the library's, then the formulas that its file declares, in
/// the order of ModelFile::effects. Texts of parameters live as long as the program.
[[nodiscard]] std::vector<EffectInfo> effects_of(const ModelFile& model);

/// Throws config::schema::ConfigError when the model's plant, if it exists, lacks a site of an
/// effect that is present, or of a formula that is declared.
void require_fit(const ModelFile& model, const std::string& file);
/// Throws config::schema::ConfigError when the plant lacks a site of the effect; `where` is
/// the place in a file, or the file.
void require_fit(const EffectInfo& effect, const PlantInfo& plant, const std::string& where);

}  // namespace plant_sim
