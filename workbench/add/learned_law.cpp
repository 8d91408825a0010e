#include <nlohmann/json.hpp>

#include "config/schema/error.h"
#include "config/schema/read_file.h"
#include "plant_sim/formula/curve_effect.h"
#include "workbench/add/declared_formula.h"

namespace workbench::add {
namespace {

using config::schema::bad_data;
using config::schema::error_line;
using config::schema::UsageError;
using nlohmann::ordered_json;
using plant_sim::formula::FormulaEffect;

constexpr const char* kLawOption = "--law";

/// The laws of a diagnosis. Throws DataError for another file.
ordered_json laws_in(const std::string& file) {
  const config::schema::FileContent in =
      config::schema::read_file(file, config::schema::kMostRecordBytes);
  if (!in.wrong.empty()) throw bad_data(file, "cannot be read (" + in.wrong + ")");
  const ordered_json json = ordered_json::parse(in.text, nullptr, false);
  if (!json.is_object() || !json.contains("laws") || !json["laws"].is_array()) {
    throw bad_data(file, "is no diagnosis", "what `spoolwatch diagnose --json` writes");
  }
  return json["laws"];
}

FormulaEffect formula_of(const ordered_json& law, std::vector<double>& values) {
  FormulaEffect effect;
  effect.name = law.at("name").get<std::string>();
  effect.site = law.at("site").get<std::string>();
  effect.formula = law.at("formula").get<std::string>();
  effect.what = law.at("what").get<std::string>();
  for (const auto& [name, p] : law.at("parameters").items()) {
    effect.parameters.push_back({name, p.at("what").get<std::string>(), p.at("min").get<double>(),
                                 p.at("max").get<double>(), p.at("typical").get<double>(),
                                 p.at("neutral").get<double>()});
    values.push_back(p.at("value").get<double>());
  }
  if (law.contains("table") && !law["table"].is_null()) {
    const ordered_json& table = law["table"];
    effect.curve = {table.at("over").get<std::string>(), table.at("times").get<std::string>(),
                    table.at("x").get<std::vector<double>>(), values};
    derive_formula(effect);
  }
  return effect;
}

}  // namespace

AddedEffect add_law(const std::string& file, const std::string& diagnosis, int number,
                    const std::string& name, const std::vector<std::string>& assignments) {
  plant_sim::ModelFile model = plant_sim::load_model(file);
  const ordered_json laws = laws_in(diagnosis);
  const auto count = static_cast<int>(laws.size());
  if (number < 1 || number > count) {
    throw UsageError(error_line(
        kLawOption,
        "is " + std::to_string(number) + ", but " + diagnosis + " has " +
            (count == 0 ? "no law" : std::to_string(count) + " laws"),
        count == 0 ? "a diagnosis with the verdict learned" : "1 to " + std::to_string(count)));
  }
  std::vector<double> values;
  FormulaEffect effect;
  try {
    effect = formula_of(laws[static_cast<std::size_t>(number - 1)], values);
  } catch (const nlohmann::json::exception& error) {
    throw bad_data(diagnosis, "has a law that is not complete",
                   "what `spoolwatch diagnose --json` of this version writes");
  }
  if (!name.empty()) effect.name = name;
  require_site(model, effect.site, kLawOption);
  for (const std::string& text : assignments) {
    const Assignment one = parse_assignment(text);
    std::size_t i = 0;
    while (i < values.size() && effect.parameters[i].name != one.name) ++i;
    if (i == values.size()) {
      throw UsageError(
          error_line(one.name, "is not in the formula", "parameters of " + effect.formula));
    }
    values[i] = one.value;
  }
  return declared(std::move(model), effect, values, kLawOption);
}

}  // namespace workbench::add
