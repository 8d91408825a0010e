#include "estimator/greybox/selection/screening_memo.h"

#include <span>

#include "estimator/greybox/selection/key_bytes.h"
#include "estimator/greybox/selection/settled_memo.h"

namespace estimator::greybox::selection {
namespace {

std::size_t kept_bytes(const std::vector<FreeParameter>& parameters) {
  return parameters.size() * (sizeof(FreeParameter) + sizeof(double));
}

std::size_t kept_bytes(const ScreeningResult& result) {
  std::size_t sum = sizeof result;
  for (const ParameterSubset& start : result.starts) sum += kept_bytes(start.parameters);
  return sum;
}

std::size_t kept_bytes(const std::vector<CurveGain>& gains) {
  return gains.size() * sizeof(CurveGain);
}

std::size_t kept_bytes(const FitSummary& fit) {
  const auto numbers = static_cast<std::size_t>(fit.residual_m.size() + fit.jacobian.size());
  return sizeof fit + kept_bytes(fit.parameters) + sizeof(double) * numbers;
}

}  // namespace

std::string ScreeningMemo::key_of(const SearchContext& context, const ModelStage& stage) {
  const FitSummary& fitted = stage.fitted;
  RecordHash hash;
  const auto add_all = [&](const auto& values) {
    hash.add(std::span<const double>(values.data(), static_cast<std::size_t>(values.size())));
  };
  add_all(fitted.residual_m);
  add_all(fitted.jacobian);
  add_all(context.problem.data.training_mask);
  add_all(context.problem.data.validation_mask);
  add_all(with_file_values(context, stage));
  hash.add(fitted.sigma_m);
  hash.add(context.problem.data.noise_floor_m);
  KeyBytes key;
  key.add(hash.value());
  key.add(context.problem.trial_sizes);
  add(key, fitted.parameters);
  key.add(
      std::span<const double>(fitted.theta.data(), static_cast<std::size_t>(fitted.theta.size())));
  return key.bytes();
}

std::string ScreeningMemo::key_of_fit(const SearchContext& plain, const ModelStage& model) {
  RecordHash hash;
  for (const Eigen::VectorXd* mask :
       {&plain.problem.data.training_mask, &plain.problem.data.validation_mask}) {
    hash.add(std::span<const double>(mask->data(), static_cast<std::size_t>(mask->size())));
  }
  KeyBytes key;
  key.add(SettledMemo::key_of(plain, model, {}, Settling::once, SimulationWidth{}));
  key.add(hash.value());
  return key.bytes();
}

std::string ScreeningMemo::key_of(const SearchContext& context,
                                  const plant_sim::EffectInfo& effect) {
  KeyBytes key;
  key.add(effect.name);
  add(key, effect_parameters(effect, kEveryRefinement));
  for (const plant_sim::formula::FormulaEffect& own : context.problem.model.formula_effects) {
    if (own.name != effect.name) continue;
    key.add(own.site);
    key.add(own.formula);
    key.add(own.memory);
    if (own.curve) key.add(std::span<const double>(own.curve->x));
  }
  return key.bytes();
}

template <class T>
std::optional<T> ScreeningMemo::find(const std::string& key) {
  const std::lock_guard lock(mutex_);
  const Kept<T>& kept = std::get<Kept<T>>(kept_);
  const auto known = kept.results.find(key);
  return known == kept.results.end() ? std::nullopt : std::optional<T>(known->second);
}

template <class T>
void ScreeningMemo::keep(const std::string& key, const T& result) {
  const std::size_t own_bytes = key.size() + kept_bytes(result);
  const std::lock_guard lock(mutex_);
  Kept<T>& kept = std::get<Kept<T>>(kept_);
  if (kept.size_bytes + own_bytes > kMost_bytes) kept = {};
  if (kept.results.try_emplace(key, result).second) kept.size_bytes += own_bytes;
}

template std::optional<ScreeningResult> ScreeningMemo::find(const std::string&);
template std::optional<std::vector<CurveGain>> ScreeningMemo::find(const std::string&);
template std::optional<FitSummary> ScreeningMemo::find(const std::string&);
template void ScreeningMemo::keep(const std::string&, const ScreeningResult&);
template void ScreeningMemo::keep(const std::string&, const std::vector<CurveGain>&);
template void ScreeningMemo::keep(const std::string&, const FitSummary&);

}  // namespace estimator::greybox::selection
