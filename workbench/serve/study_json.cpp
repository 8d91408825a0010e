// A study as the page takes it: words and figures as the commands write them, curves in the units
// that read well.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/signals/nan.h"
#include "config/units/quantity.h"
#include "estimator/greybox/parameter_catalogue.h"
#include "workbench/compare/comparison_report.h"
#include "workbench/compare/region_spans.h"
#include "workbench/laws/laws.h"
#include "workbench/present/compare_units.h"
#include "workbench/present/json.h"
#include "workbench/present/plot_data.h"
#include "workbench/present/printed_axis.h"
#include "workbench/present/record_section.h"
#include "workbench/present/script_json.h"
#include "workbench/present/shell_command.h"
#include "workbench/present/text.h"
#include "workbench/serve/model_difference.h"
#include "workbench/serve/slider_unit.h"
#include "workbench/serve/study.h"

namespace workbench::serve {
namespace {

using nlohmann::ordered_json;
using present::number_or_null;
using present::typeset;
using present::typeset_all;

constexpr std::size_t kMostRegions = 5;
/// A slider reaches from a plant's value over this ratio to the value times this ratio.
constexpr double kWidestRatio = 2.0;
/// A slider of an effect reaches to this many of its typical sizes.
constexpr double kTypicalSizes = 3.0;

ordered_json json_of(const validation::Comparison& comparison,
                     const validation::SignificantRegion& region) {
  ordered_json spans = ordered_json::array();
  for (const compare::TimeSpan& span : compare::region_spans(comparison, region)) {
    spans.push_back({span.from_s, span.to_s});
  }
  const validation::Bin& figures = region.figures;
  return {{"where", typeset(present::where(region))},
          {"rms", typeset(config::units::length_words(figures.rms_m))},
          {"share", present::percent(figures.local_velocity_error_share)},
          {"time_share", present::percent(figures.time_share)},
          {"stands_out", region.significant},
          {"spans", spans}};
}

ordered_json regions_of(const validation::Comparison& comparison) {
  ordered_json regions = ordered_json::array();
  const validation::SignificantRegion& headline = comparison.headline;
  if (headline.significant && !headline.ranges.empty()) {
    regions.push_back(json_of(comparison, headline));
  }
  for (const validation::SignificantRegion& region : comparison.worst) {
    if (regions.size() == kMostRegions || !region.significant) continue;
    const bool said =
        headline.ranges.size() == 1 && present::where(region) == present::where(headline);
    if (!said) regions.push_back(json_of(comparison, region));
  }
  return regions;
}

const char* to_string(compare::Judgement judgement) {
  switch (judgement) {
    case compare::Judgement::at_floor:
      return "good";
    case compare::Judgement::fails_somewhere:
      return "warn";
    case compare::Judgement::fails_throughout:
    case compare::Judgement::useless:
      break;
  }
  return "bad";
}

ordered_json json_of(const validation::Comparison& comparison, double heldout_m) {
  const compare::Words said = compare::words(comparison);
  const auto length = [](double value_m) { return typeset(config::units::length_words(value_m)); };
  ordered_json out;
  out["judgement"] = to_string(said.judgement);
  out["verdict"] = typeset(said.verdict);
  out["lines"] = typeset_all(said.lines);
  out["notes"] = typeset_all(compare::notes(comparison));
  out["figures"] = {{{"label", "error, drift-corrected"}, {"value", length(comparison.rms_m)}},
                    {{"label", "held-out blocks"}, {"value", length(heldout_m)}},
                    {{"label", "free run"}, {"value", length(comparison.free_run_rms_m)}},
                    {{"label", "noise floor"}, {"value", length(comparison.noise_floor_m)}}};
  out["rms_m"] = number_or_null(comparison.rms_m);
  out["heldout_m"] = number_or_null(heldout_m);
  out["noise_floor_m"] = number_or_null(comparison.noise_floor_m);
  out["from_s"] = comparison.record.t_s.front();
  out["to_s"] = comparison.record.t_s.back();
  out["regions"] = regions_of(comparison);
  return out;
}

/// A slider's range: about the value, within what is allowed.
ordered_json json_of(const greybox::CatalogueParameter& parameter, double value) {
  const plant_sim::ParameterInfo& info = parameter.info;
  const bool logarithmic = parameter.effect.empty() && value > 0.0;
  double low = value / kWidestRatio;
  double high = value * kWidestRatio;
  if (!logarithmic) {
    const double reach = std::max(kTypicalSizes * std::abs(info.typical), 2.0 * std::abs(value));
    low = info.min < 0.0 ? -reach : 0.0;
    high = reach;
  }
  low = std::max(low, info.min);
  high = std::min(high, info.max);
  const config::units::PrintedScale scale = slider_unit(parameter, value);
  return {{"name", parameter.name},
          {"words", config::units::parameter_words(parameter.name)},
          {"what", config::units::axis_words(info.what)},
          {"unit", typeset(" " + scale.unit).substr(1)},
          {"in_si", scale.in_si},
          {"effect", parameter.effect},
          {"value", number_or_null(value)},
          {"low", number_or_null(low)},
          {"high", number_or_null(high)},
          {"logarithmic", logarithmic}};
}

/// The plant's uncertain parameters and all parameters of the effects that are present.
ordered_json parameters_of(const plant_sim::ModelFile& model) {
  plant_sim::ModelFile copy = model;
  ordered_json out = ordered_json::array();
  for (const greybox::CatalogueParameter& parameter : greybox::parameter_catalogue(model)) {
    if (parameter.effect.empty()) {
      if (parameter.info.uncertainty_ratio <= 0.0) continue;
    } else {
      const bool present =
          std::any_of(model.effects.begin(), model.effects.end(),
                      [&](const auto& one) { return one.name == parameter.effect && one.present; });
      if (!present) continue;
    }
    const double* const value = copy.value(parameter.name);
    if (value != nullptr && std::isfinite(*value)) out.push_back(json_of(parameter, *value));
  }
  return out;
}

ordered_json listed_effects(const plant_sim::ModelFile& model) {
  const plant_sim::PlantInfo* const plant = plant_sim::find_plant(model.plant);
  ordered_json out = ordered_json::array();
  const std::vector<plant_sim::EffectInfo> effects = plant_sim::effects_of(model);
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const plant_sim::EffectInfo& effect = effects[i];
    const bool fits = std::all_of(effect.sites.begin(), effect.sites.end(), [&](const auto& site) {
      return std::find(plant->sites.begin(), plant->sites.end(), site) != plant->sites.end();
    });
    if (!fits) continue;
    out.push_back({{"name", effect.name},
                   {"equation", effect.equation},
                   {"present", model.effects[i].present}});
  }
  return out;
}

/// One value per sample and a missing one between segments.
template <class Value>
std::vector<double> broken(const greybox::Dataset& record, Value value) {
  std::vector<double> out;
  std::size_t segment = 1;
  for (std::size_t k = 0; k < record.size(); ++k) {
    if (segment < record.starts.size() && record.starts[segment] == k) {
      out.push_back(config::signals::kNaN);
      ++segment;
    }
    out.push_back(value(k));
  }
  return out;
}

std::vector<double> times_of(const greybox::Dataset& record) {
  std::vector<double> t_s;
  std::size_t segment = 1;
  for (std::size_t k = 0; k < record.size(); ++k) {
    if (segment < record.starts.size() && record.starts[segment] == k) {
      t_s.push_back(0.5 * (record.t_s[k - 1] + record.t_s[k]));
      ++segment;
    }
    t_s.push_back(record.t_s[k]);
  }
  return t_s;
}

struct Column {
  const char* name;
  std::vector<double> values;
};

/// Rows of `columns` within `view`, thinned so that no peak of any column is lost.
std::vector<std::size_t> rows_of(const std::vector<double>& t_s, const std::vector<Column>& columns,
                                 const View& view) {
  auto from = t_s.begin();
  auto to = t_s.end();
  if (view.to_s > view.from_s) {
    // One row to either side, so that lines reach the edges.
    from = std::lower_bound(t_s.begin(), t_s.end(), view.from_s);
    to = std::upper_bound(from, t_s.end(), view.to_s);
    if (from != t_s.begin()) --from;
    if (to != t_s.end()) ++to;
  }
  const auto begin = static_cast<std::size_t>(from - t_s.begin());
  std::vector<std::vector<double>> parts;
  std::vector<const std::vector<double>*> all;
  all.reserve(columns.size());
  for (const Column& column : columns) {
    const auto first = column.values.begin() + static_cast<std::ptrdiff_t>(begin);
    parts.emplace_back(first, first + (to - from));
  }
  for (const std::vector<double>& part : parts) all.push_back(&part);
  std::vector<std::size_t> rows = present::thin_lines(
      all, static_cast<std::size_t>(to - from), std::clamp<std::size_t>(view.rows, 200, 20'000));
  for (std::size_t& row : rows) row += begin;
  return rows;
}

/// ,"name":[...]
std::string array(const char* name, const std::vector<double>& values,
                  const std::vector<std::size_t>& rows) {
  std::vector<double> picked;
  picked.reserve(rows.size());
  for (const std::size_t row : rows) picked.push_back(values[row]);
  return ",\"" + std::string(name) + "\":" + present::json_numbers(picked);
}

constexpr double kMillimetres = 1e3;

/// Free run in mm and error in `unit`.
std::vector<Column> model_columns(const greybox::Dataset& record,
                                  const std::vector<double>& error_m,
                                  const std::vector<double>& free_error_m,
                                  const present::ErrorUnit& unit, bool ghost) {
  return {
      {ghost ? "ghost_model" : "model",
       broken(record, [&](auto k) { return kMillimetres * (record.y_m[k] - free_error_m[k]); })},
      {ghost ? "ghost_error" : "error", broken(record, [&](auto k) {
         return record.valid[k] != 0 ? unit.per_m * error_m[k] : config::signals::kNaN;
       })}};
}

}  // namespace

std::string Study::columns(const validation::ModelErrors* changed, const View& view) const {
  const Shown& shown = front();
  const Shown* const ghost = this->ghost();
  const validation::Comparison& c = shown.comparison;
  const greybox::Dataset& record = c.record;
  const double greatest_m = std::max(c.rms_m, ghost != nullptr ? ghost->comparison.rms_m : 0.0);
  const present::ErrorUnit unit = present::error_unit(greatest_m);
  std::vector<Column> columns{
      {"measured", broken(record, [&](auto k) { return kMillimetres * record.y_m[k]; })},
      {"command", broken(record, [&](auto k) { return record.u_V[k]; })}};
  const auto add = [&](std::vector<Column> more) {
    for (Column& column : more) columns.push_back(std::move(column));
  };
  add(model_columns(record, c.error_m, c.free_error_m, unit, false));
  if (ghost != nullptr) {
    const validation::Comparison& g = ghost->comparison;
    add(model_columns(record, g.error_m, g.free_error_m, unit, true));
  }
  const std::vector<double> t_s = times_of(record);
  const std::vector<std::size_t> rows = rows_of(t_s, columns, view);
  std::string json = R"({"rows":)" + std::to_string(rows.size());
  double rms_m = c.rms_m;
  if (changed != nullptr) {
    // The same rows as those of the curves, which the page has.
    rms_m = changed->rms_m;
    columns = model_columns(record, changed->error_m, changed->free_error_m, unit, false);
  } else {
    json += array("t", t_s, rows);
  }
  for (const Column& column : columns) json += array(column.name, column.values, rows);
  const std::string& position = shown.prepared.units.position;
  return json + R"(,"unit":)" + present::json_string(typeset(config::units::axis_unit(unit.name))) +
         R"(,"floor":)" + present::json_number(2.0 * unit.per_m * c.noise_floor_m) + R"(,"rms":)" +
         present::json_string(typeset(config::units::length_words(rms_m))) + R"(,"rms_m":)" +
         present::json_number(rms_m) + R"(,"position_unit":)" +
         present::json_string(position == "m" ? config::units::axis_unit("mm") : "m" + position) +
         R"(,"command_unit":)" + present::json_string(shown.prepared.units.command) + "}";
}

namespace {

std::string json_of(const laws::LawCurve& curve) {
  return R"({"x":)" + present::json_numbers(curve.x) + R"(,"y":)" + present::json_numbers(curve.y) +
         "}";
}

}  // namespace

std::string Study::laws() const {
  const Shown& shown = front();
  const present::PrintedAxis axis(motion());
  const std::vector<laws::Law> all = laws::laws_of(shown.prepared.model, shown.comparison);
  std::vector<laws::Law> before;
  if (const Shown* const other = ghost()) {
    before = laws::laws_of(other->prepared.model, shown.comparison);
  }
  std::string json = R"({"laws":[)";
  for (std::size_t i = 0; i < all.size(); ++i) {
    const laws::Law& law = all[i];
    const auto label = [](const std::string& name, const std::string& unit) {
      return present::json_string(fmt::format("{}, {}", name, unit));
    };
    json +=
        std::string(i == 0 ? "" : ",") + R"({"title":)" + present::json_string(law.title) +
        R"(,"x":)" + label(law.x_name, law.x_unit) + R"(,"y":)" + label(law.y_name, law.y_unit) +
        R"(,"note":)" + present::json_string(law.note) + R"(,"model":)" + json_of(law.model) +
        R"(,"samples":)" + json_of(law.samples) + R"(,"mean":)" + json_of(law.mean) +
        R"(,"before":)" +
        (i < before.size() && before[i].title == law.title ? json_of(before[i].model) : "null") +
        "}";
  }
  return json + "]}";
}

ordered_json Study::side_by_side() const {
  if (!beside_) return nullptr;
  const Shown& shown = front();
  const auto figures = [](const Shown& one) {
    ordered_json texts = ordered_json::array();
    for (const double value_m :
         {one.comparison.rms_m, one.heldout_m, one.comparison.free_run_rms_m}) {
      texts.push_back(typeset(config::units::length_words(value_m)));
    }
    return texts;
  };
  ordered_json out{{"model", open_.beside}, {"shown", shown_model()}};
  out["figures"] = {{"labels", {"error, drift-corrected", "held-out blocks", "free run"}},
                    {"here", figures(shown)},
                    {"there", figures(*beside_)}};
  out["differences"] = ordered_json::array();
  for (const ModelDifference& one : differences(shown.prepared.model, beside_->prepared.model)) {
    const auto dot = one.name.find('.');
    const std::string effect = dot == std::string::npos ? "" : one.name.substr(0, dot) + ": ";
    out["differences"].push_back({{"name", one.name},
                                  {"words", effect + config::units::parameter_words(one.name)},
                                  {"here", typeset(one.here)},
                                  {"there", typeset(one.there)}});
  }
  return out;
}

ordered_json Study::state() {
  const present::PrintedAxis axis(motion());
  ordered_json out{{"record", open_.record}, {"model", open_.model}, {"trial", open_.trial}};
  out["notice"] = notice_;
  out["ignored"] = open_.ignored;
  out["files"] = ordered_json::array();
  for (const FolderFile& file : folder_.files()) {
    out["files"].push_back({{"name", file.name}, {"kind", file.kind}, {"bytes", file.bytes}});
  }
  out["shipped"] = ordered_json::array();
  for (const ShippedModel& model : shipped_models()) out["shipped"].push_back(model.name);
  const std::optional<Shown>& shown = tried_ ? tried_ : accepted_;
  out["shown"] = nullptr;
  if (shown) {
    out["shown"] = json_of(shown->comparison, shown->heldout_m);
    std::vector<std::string> words{"spoolwatch", "compare", shown_model(), open_.record};
    for (const std::string& span : open_.ignored) words.insert(words.end(), {"--ignore", span});
    out["shown"]["command"] = present::shell_command(words);
  }
  out["parameters"] = ordered_json::array();
  out["effects"] = ordered_json::array();
  if (open_.shown) {
    out["parameters"] = parameters_of(*open_.shown);
    out["effects"] = listed_effects(*open_.shown);
  }
  const ordered_json lineage = to_json(open_.lineage);
  out["beside"] = side_by_side();
  out["lineage"] = lineage["nodes"];
  for (ordered_json& node : out["lineage"]) {
    const ModelNode* const known = open_.lineage.find(node["model"].get<std::string>());
    const present::PrintedAxis own(known->rotary ? config::units::Motion::rotary
                                                 : config::units::Motion::linear);
    node["heldout"] = typeset(config::units::length_words(known->heldout_m));
  }
  out["commands"] = lineage["commands"];
  return out;
}

}  // namespace workbench::serve
