#include "estimator/greybox/selection/settled_memo.h"

#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "estimator/greybox/innovation_gains.h"
#include "estimator/greybox/selection/confidence.h"
#include "estimator/greybox/selection/innovation_round.h"
#include "estimator/greybox/selection/innovation_trials.h"
#include "estimator/greybox/selection/key_bytes.h"

namespace estimator::greybox::selection {
namespace {

std::uint64_t hash_of(const FitDataset& data) {
  RecordHash hash;
  for (const Dataset& record : data.records) {
    assert(!record.innovations);
    hash.add(record.size());
    hash.add(record.sample_time_s);
    hash.add(record.t_s);
    hash.add(record.u_V);
    hash.add(record.y_m);
    for (const std::size_t start : record.starts) hash.add(start);
    for (std::size_t k = 0; k < record.size(); ++k) {
      hash.add(static_cast<std::uint64_t>(record.valid[k]) << 8U |
               static_cast<std::uint64_t>(record.initialising[k]));
    }
  }
  hash.add(std::span(data.all_mask.data(), static_cast<std::size_t>(data.all_mask.size())));
  return hash.value();
}

/// The model without formulas that are only candidates.
plant_sim::ModelFile in_use(plant_sim::ModelFile model, const ModelStage& stage) {
  const auto is_used = [&](const std::string& name) {
    return std::any_of(model.effects.begin(), model.effects.end(),
                       [&](const auto& one) { return one.name == name && one.present; }) ||
           std::any_of(stage.fitted.parameters.begin(), stage.fitted.parameters.end(),
                       [&](const FreeParameter& p) { return belongs_to(p, name); });
  };
  std::vector<std::string> unused;
  for (const plant_sim::formula::FormulaEffect& formula : model.formula_effects) {
    if (!is_used(formula.name)) unused.push_back(formula.name);
  }
  const auto is_unused = [&](const auto& one) {
    return std::find(unused.begin(), unused.end(), one.name) != unused.end();
  };
  std::erase_if(model.formula_effects, is_unused);
  std::erase_if(model.effects, is_unused);
  return model;
}

void add(KeyBytes& key, const disturbance::NoiseModel& noise) {
  for (const double value : {noise.noise.disturbance_sd, noise.noise.corner_Hz, noise.noise.walk_m,
                             noise.noise.sensor_m, noise.force_place}) {
    key.add(value);
  }
  key.add(noise.lines.size());
  for (const disturbance::SpectralLine& line : noise.lines) {
    key.add(line.site);
    key.add(line.frequency_Hz);
  }
  key.add(noise.waves.size());
  for (const std::vector<Eigen::Vector2d>& records : noise.waves) {
    key.add(records.size());
    for (const Eigen::Vector2d& wave : records) {
      key.add(wave[0]);
      key.add(wave[1]);
    }
  }
}

std::size_t size_bytes_of(const InnovationStage& stage,
                          const std::vector<PackedLinearisation>& linear) {
  std::size_t numbers = static_cast<std::size_t>(stage.model.fitted.residual_m.size() +
                                                 stage.model.fitted.jacobian.size());
  std::size_t bytes = 0;
  for (const PackedLinearisation& one : linear) bytes += one.size_bytes();
  for (const Dataset& record : stage.context.problem.data.records) {
    const InnovationGains& gains = *record.innovations;
    numbers += static_cast<std::size_t>(gains.gain.size() + gains.scale.size() +
                                        gains.lines.size() + gains.line_m.size());
  }
  return bytes + numbers * sizeof(double);
}

}  // namespace

std::string SettledMemo::key_of(const SearchContext& plain, const ModelStage& model,
                                const disturbance::NoiseModel& start, Settling effort,
                                SimulationWidth width) {
  const DiagnosisProblem& problem = plain.problem;
  KeyBytes key;
  key.add(effort == Settling::fully);
  key.add(width.groups);  // a part of a fit's result, as the number of threads is not
  key.add(hash_of(problem.data));
  for (const double value : {problem.data.noise_floor_m, problem.data.least_floor_m,
                             problem.data.most_sensor_ratio, problem.data.sample_time_s}) {
    key.add(value);
  }
  key.add(plant_sim::print_model(in_use(problem.model, model)));
  for (const Dataset& record : problem.data.records) {
    key.add(record.name);
    key.add(record.command_is_interpolated);
  }
  key.add(problem.plant_parameters.size());
  key.add(model.added.size());
  for (const std::string& name : model.added) key.add(name);
  // the candidates' refinements take the place of one another
  for (const plant_sim::EffectInfo& effect : problem.candidate_effects) {
    if (std::find(model.added.begin(), model.added.end(), effect.name) == model.added.end())
      continue;
    key.add(effect.name);
    add(key, effect_parameters(effect, kEveryRefinement));
  }
  add(key, model.fitted.parameters);
  const Eigen::VectorXd& theta = model.fitted.theta;
  key.add(std::span(theta.data(), static_cast<std::size_t>(theta.size())));
  add(key, start);
  return key.bytes();
}

std::shared_ptr<const SettledMemo::Kept> SettledMemo::use(const std::string& key) {
  const auto known = stages_.find(key);
  if (known == stages_.end()) return {};
  by_use_.splice(by_use_.end(), by_use_, known->second.use);
  return known->second.kept;
}

std::optional<InnovationStage> SettledMemo::find(const SearchContext& plain,
                                                 const std::string& key) {
  std::shared_ptr<const Kept> kept;
  {
    const std::lock_guard lock(mutex_);
    kept = use(key);
  }
  if (!kept) return {};
  InnovationStage stage = kept->stage;
  for (const PackedLinearisation& one : kept->linear) stage.linear.push_back(one.unpacked());
  stage.context = plain;
  FitDataset& data = stage.context.problem.data;
  for (std::size_t r = 0; r < data.records.size(); ++r)
    data.records[r].innovations = kept->gains[r];
  disturbance::score_every_sample(data);
  return stage;
}

double SettledMemo::least_minus_two_log(const SearchContext& plain) {
  const std::uint64_t records = hash_of(plain.problem.data);
  const std::lock_guard lock(mutex_);
  const auto known = least_.find(records);
  return known == least_.end() ? std::numeric_limits<double>::infinity() : known->second;
}

void SettledMemo::keep(const SearchContext& plain, const std::string& key,
                       const InnovationStage& stage) {
  auto kept = std::make_shared<Kept>();
  for (const disturbance::Linearisation& one : stage.linear) kept->linear.emplace_back(one);
  kept->size_bytes = size_bytes_of(stage, kept->linear) + key.size();
  for (const Dataset& record : stage.context.problem.data.records)
    kept->gains.push_back(record.innovations);
  kept->stage.model = stage.model;
  kept->stage.noise = stage.noise;
  kept->stage.minus_two_log = stage.minus_two_log;
  const std::uint64_t records = hash_of(plain.problem.data);
  const std::lock_guard lock(mutex_);
  if (stage.noise.lines.empty() && stage.model.added.size() < kStandIn &&
      effect_out_of_range(stage).empty()) {
    double& least = least_.try_emplace(records, penalised(stage)).first->second;
    least = std::min(least, penalised(stage));
  }
  const auto [at, is_new] = stages_.try_emplace(key);
  if (!is_new) return;
  size_bytes_ += kept->size_bytes;
  at->second = {std::move(kept), by_use_.insert(by_use_.end(), &at->first)};
  while (size_bytes_ > most_bytes_) {
    const auto oldest = stages_.find(*by_use_.front());
    size_bytes_ -= oldest->second.kept->size_bytes;
    by_use_.pop_front();
    stages_.erase(oldest);
  }
}

}  // namespace estimator::greybox::selection
