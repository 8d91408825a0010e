#include "workbench/diagnose/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "workbench/cli/file_check.h"
#include "workbench/fit/ignored_spans.h"

namespace workbench::diagnose {
namespace {

void check_files(const DiagnosisRequest& request) {
  cli::check_records(request.records, request.holdouts,
                     "another record, or --fit first-half to score on part of this one");
  cli::InputFiles inputs{request.model, request.records};
  inputs.records.insert(inputs.records.end(), request.holdouts.begin(), request.holdouts.end());
  cli::check_outputs(
      {{"--json", request.json}, {"--report", request.report}, {"-o", request.output, true}},
      inputs);
}

/// Refuses samples too far apart: noise is told from a motion by how smooth the motion is.
void require_rate(const greybox::Dataset& record) {
  constexpr double kSlowest_s = 0.05;
  if (record.sample_time_s <= kSlowest_s * (1.0 + 1e-6)) return;
  throw config::schema::bad_data(
      record.name,
      fmt::format("{:.3g} samples a second are too few to tell noise from motion",
                  1.0 / record.sample_time_s),
      "20 Hz or more; compare and fit take less");
}

std::vector<greybox::Dataset> records_of(const std::vector<std::string>& files) {
  std::vector<greybox::Dataset> records;
  for (const std::string& file : files) {
    records.push_back(greybox::dataset_of(config::record::read_record(file)));
    require_rate(records.back());
  }
  return records;
}

/// Leaves the effects that are to be tried.
void choose_effects(const DiagnosisRequest& request, std::vector<plant_sim::EffectInfo>& effects) {
  const auto names = [](const std::vector<std::string>& list, const plant_sim::EffectInfo& effect) {
    return std::find(list.begin(), list.end(), effect.name) != list.end();
  };
  for (const auto& [option, list] :
       {std::pair("--only", &request.only), std::pair("--without", &request.without)}) {
    for (const std::string& name : *list) {
      const auto named = [&](const plant_sim::EffectInfo& effect) { return effect.name == name; };
      if (std::any_of(effects.begin(), effects.end(), named)) continue;
      const auto text = [](const plant_sim::EffectInfo& effect) { return effect.name; };
      throw config::schema::UsageError(
          fmt::format("{}: {} is no effect that this model lacks; allowed: {}", option, name,
                      config::schema::joined_by(effects, text, ", ")));
    }
  }
  std::erase_if(effects, [&](const plant_sim::EffectInfo& effect) {
    return (!request.only.empty() && !names(request.only, effect)) ||
           names(request.without, effect);
  });
}

}  // namespace

PreparedDiagnosis prepare(const DiagnosisRequest& request) {
  check_files(request);
  PreparedDiagnosis prepared;
  prepared.split = greybox::parse_split(request.fit);
  plant_sim::ModelFile model = plant_sim::load_model(request.model, request.assignments);
  fit::FreeParameters parameters = fit::select_parameters(model, request.selection);
  std::vector<greybox::Dataset> records = records_of(request.records);
  fit::for_ignored(request.ignored, records, [&](std::size_t record, std::size_t sample) {
    records[record].valid[sample] = 0;
  });
  prepared.problem = selection::make_problem(
      std::move(model),
      greybox::fit_dataset(std::move(records), records_of(request.holdouts), prepared.split));
  prepared.problem.plant_parameters = std::move(parameters.parameters);
  if (request.flip) {
    for (greybox::Dataset& record : prepared.problem.data.records) {
      for (double& u_V : record.u_V) u_V = -u_V;
    }
  }
  choose_effects(request, prepared.problem.candidate_effects);
  const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
  prepared.options.threads = request.threads > 0 ? request.threads : processors;
  prepared.model_file = request.model;
  prepared.records = request.records;
  prepared.holdouts = request.holdouts;
  prepared.output = request.output;
  prepared.command = request.command;
  return prepared;
}

}  // namespace workbench::diagnose
