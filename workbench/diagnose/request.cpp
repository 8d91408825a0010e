#include "workbench/diagnose/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <thread>
#include <utility>

#include "config/record/record.h"
#include "config/record/text_fields.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"
#include "estimator/greybox/parameter_catalogue.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "workbench/diagnose/leaps.h"
#include "workbench/files/file_check.h"
#include "workbench/fit/ignored_spans.h"
#include "workbench/present/dataset_notes.h"
#include "workbench/present/printed_axis.h"

namespace workbench::diagnose {
namespace {

void check_files(const DiagnosisRequest& request) {
  files::check_records(request.records, request.holdouts,
                       "another record, or --fit first-half to score on part of this one");
  files::InputFiles inputs{request.model, request.records};
  inputs.records.insert(inputs.records.end(), request.holdouts.begin(), request.holdouts.end());
  files::check_outputs(
      {{"--json", request.json}, {"--report", request.report}, {"-o", request.output, true}},
      inputs);
}

std::vector<greybox::Dataset> records_of(const std::vector<std::string>& files,
                                         const DiagnosisRequest& request) {
  std::vector<config::record::Record> records;
  records.reserve(files.size());
  std::vector<config::record::RecordUnits> units;
  for (const std::string& file : files) {
    records.push_back(config::record::read_record(file, request.reading));
    units.push_back(config::record::units_of(records.back()));
  }
  config::record::require_same_units(units);
  fit::cut_ignored(request.ignored, files, records);
  std::vector<greybox::Dataset> sets;
  sets.reserve(records.size());
  for (const config::record::Record& record : records) {
    sets.push_back(dataset_without_leaps(record));
  }
  return sets;
}

/// Refuses data of which too little is fitted or scored: an error over no samples is none.
void require_samples(const greybox::FitDataset& data, std::size_t parameters) {
  constexpr double kPerParameter = 10.0;
  const double least = kPerParameter * static_cast<double>(parameters);
  const double fitted = data.training_mask.sum();
  const double scored = data.validation_mask.sum();
  if (fitted >= least && scored >= least) return;
  throw config::schema::bad_data(
      data.records.front().name,
      fmt::format("leaves {:.0f} samples to fit and {:.0f} to score", fitted, scored),
      fmt::format("{:.0f} or more of each: a longer record, or less to --ignore", least));
}

/// Names without blanks around: "friction " of "--only 'friction , backlash'".
std::vector<std::string> trimmed_names(std::vector<std::string> names) {
  for (std::string& name : names) name = config::record::trimmed(name);
  return names;
}

/// Leaves the effects that are to be tried.
void choose_effects(const DiagnosisRequest& request, std::vector<plant_sim::EffectInfo>& effects) {
  const std::vector<std::string> only = trimmed_names(request.only);
  const std::vector<std::string> without = trimmed_names(request.without);
  const auto names = [](const std::vector<std::string>& list, const plant_sim::EffectInfo& effect) {
    return std::any_of(list.begin(), list.end(), [&](const std::string& name) {
      return plant_sim::library_name(name) == effect.name;
    });
  };
  for (const auto& [option, list] :
       {std::pair("--only", &only), std::pair("--without", &without)}) {
    for (const std::string& name : *list) {
      const auto named = [&, known = plant_sim::library_name(name)](
                             const plant_sim::EffectInfo& effect) { return effect.name == known; };
      if (std::any_of(effects.begin(), effects.end(), named)) continue;
      std::vector<std::string> lacking;
      lacking.reserve(effects.size());
      for (const plant_sim::EffectInfo& effect : effects) lacking.push_back(effect.name);
      const std::string near = config::schema::nearest(name, lacking);
      throw config::schema::UsageError(fmt::format(
          "{}: '{}' is not among the effects that can be added to this model{}; allowed: {}",
          option, name, near.empty() ? "" : ", did you mean " + near + "?",
          config::schema::joined(lacking)));
    }
  }
  std::erase_if(effects, [&](const plant_sim::EffectInfo& effect) {
    return (!only.empty() && !names(only, effect)) || names(without, effect);
  });
  if (effects.empty() && !only.empty()) {
    throw config::schema::UsageError("--without names every effect of --only: " +
                                     config::schema::joined(only) + "; none is left to try");
  }
}

/// Parameters of an effect that the model has are not sought where they are fixed.
void keep_fixed(const std::string& name, plant_sim::EffectInfo& refinements) {
  const std::size_t dot = name.find('.');
  std::erase_if(refinements.parameters, [&](const plant_sim::ParameterInfo& p) {
    return dot == std::string::npos || name.substr(dot + 1) == p.name;
  });
  selection::give_size(refinements);
}

/// Refuses to keep what the model does not have: the sizes of such effects are what is sought.
void require_fixed_present(const DiagnosisRequest& request, const plant_sim::ModelFile& model,
                           std::vector<plant_sim::EffectInfo>& candidates) {
  for (const std::string& name : greybox::split_names(request.selection.fix)) {
    const std::string effect = plant_sim::library_name(name.substr(0, name.find('.')));
    const auto sought = std::find_if(candidates.begin(), candidates.end(),
                                     [&](const auto& one) { return one.name == effect; });
    if (sought == candidates.end()) continue;
    const plant_sim::EffectInfo* known = plant_sim::find_effect(effect);
    if (known != nullptr && selection::has_effect(model, *known)) {
      keep_fixed(name, *sought);
      if (sought->parameters.empty()) candidates.erase(sought);
      continue;
    }
    throw config::schema::UsageError(fmt::format(
        "--fix {}: the model states no size of {}, which is sought; --without {} leaves it out",
        name, effect, effect));
  }
}

/// Gives every parameter one place: an effect that the model declares without a size is sought, or
/// is part of the model where --free names it.
void part_from_candidates(const DiagnosisRequest& request, selection::DiagnosisProblem& problem) {
  const auto belongs = [](const greybox::FreeParameter& parameter,
                          const plant_sim::EffectInfo& effect) {
    return selection::belongs_to(parameter, effect.name);
  };
  if (request.selection.free.empty()) {
    std::erase_if(problem.plant_parameters, [&](const greybox::FreeParameter& parameter) {
      return std::any_of(problem.candidate_effects.begin(), problem.candidate_effects.end(),
                         [&](const auto& effect) { return belongs(parameter, effect); });
    });
  } else {
    std::erase_if(problem.candidate_effects, [&](const plant_sim::EffectInfo& effect) {
      return std::any_of(problem.plant_parameters.begin(), problem.plant_parameters.end(),
                         [&](const auto& parameter) { return belongs(parameter, effect); });
    });
  }
}

}  // namespace

PreparedDiagnosis prepare(const DiagnosisRequest& request) {
  check_files(request);
  PreparedDiagnosis prepared;
  prepared.split = greybox::parse_split(request.fit);
  plant_sim::ModelFile model = plant_sim::load_model(request.model, request.assignments);
  const present::PrintedAxis axis(present::motion_of(model));
  fit::FreeParameters parameters = fit::select_parameters(model, request.selection);
  std::vector<std::string> files = request.records;
  files.insert(files.end(), request.holdouts.begin(), request.holdouts.end());
  std::vector<greybox::Dataset> records = records_of(files, request);
  for (greybox::Dataset& record : records) present::note_against_model(model, record);
  const auto held_out = records.begin() + static_cast<std::ptrdiff_t>(request.records.size());
  std::vector<greybox::Dataset> holdouts(std::make_move_iterator(held_out),
                                         std::make_move_iterator(records.end()));
  records.erase(held_out, records.end());
  prepared.problem = selection::make_problem(
      std::move(model),
      greybox::fit_dataset(std::move(records), std::move(holdouts), prepared.split));
  prepared.problem.plant_parameters = std::move(parameters.parameters);
  part_from_candidates(request, prepared.problem);
  require_samples(prepared.problem.data, prepared.problem.plant_parameters.size());
  choose_effects(request, prepared.problem.candidate_effects);
  require_fixed_present(request, prepared.problem.model, prepared.problem.candidate_effects);
  prepared.problem.effects_only = !request.only.empty();
  const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
  prepared.options.threads = request.threads > 0 ? request.threads : processors;
  prepared.model_file = request.model;
  prepared.records = request.records;
  prepared.holdouts = request.holdouts;
  prepared.output = request.output;
  prepared.command = request.command;
  prepared.reading = request.reading;
  prepared.ignored = request.ignored;
  prepared.within_s = request.within_s;
  return prepared;
}

}  // namespace workbench::diagnose
