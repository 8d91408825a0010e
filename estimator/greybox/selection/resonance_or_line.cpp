#include "estimator/greybox/selection/resonance_or_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "estimator/greybox/selection/innovation_rivals.h"
#include "estimator/greybox/selection/innovation_round.h"
#include "estimator/greybox/selection/likeliest_start.h"
#include "estimator/greybox/selection/spectral_line_candidates.h"
#include "estimator/greybox/sensor_place.h"

namespace estimator::greybox::selection {

namespace {

/// Distance of a resonance from a spectral line, as a share of its frequency, within which they are
/// one.
constexpr double kOnALine = 0.05;
/// Damping ratio below which a resonance may be a line: metal structures have some 0.01.
constexpr double kHardlyDamped_ratio = 0.01;
/// Damping ratio above which a resonance is too broad to stand for a line at its frequency.
constexpr double kBroad_ratio = 0.02;
/// Times over that a second mass is reconsidered while that makes it clearly likelier.
constexpr int kMostReconsidered = 3;
constexpr std::string_view kFrequency = ".resonance_Hz";

bool is_on(const disturbance::SpectralLine& line, double resonance_Hz) {
  return std::abs(resonance_Hz - line.frequency_Hz) < kOnALine * line.frequency_Hz;
}

double value_or(const FitSummary& fitted, const std::string& name, double otherwise) {
  const double value = fitted.value(name);
  return std::isfinite(value) ? value : otherwise;
}

/// The effect of the stage that rings for long; empty: none.
std::string ringing_effect(const InnovationStage& stage) {
  const FitSummary& fitted = stage.model.fitted;
  for (const std::string& effect : stage.model.added) {
    if (std::isfinite(fitted.value(effect + std::string(kFrequency))) &&
        value_or(fitted, effect + ".damping_ratio", 0.0) < kHardlyDamped_ratio) {
      return effect;
    }
  }
  return "";
}

/// The stage's resonance, Hz; NaN: none.
double found_resonance_Hz(const InnovationStage& stage) {
  for (const std::string& effect : stage.model.added) {
    const double found_Hz = stage.model.fitted.value(effect + std::string(kFrequency));
    if (std::isfinite(found_Hz)) return found_Hz;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::optional<InnovationStage> without_lines_of_resonance(const SearchContext& plain,
                                                          const InnovationStage& stage) {
  const double found_Hz = found_resonance_Hz(stage);
  disturbance::NoiseModel noise;
  noise.noise = stage.noise.noise;
  noise.force_place = stage.noise.force_place;
  for (std::size_t i = 0; i < stage.noise.lines.size(); ++i) {
    if (is_on(stage.noise.lines[i], found_Hz)) continue;
    noise.lines.push_back(stage.noise.lines[i]);
    if (i < stage.noise.waves.size()) noise.waves.push_back(stage.noise.waves[i]);
  }
  const auto fewer = static_cast<double>(stage.noise.lines.size() - noise.lines.size());
  if (fewer == 0.0 || plain.cancelled()) return {};
  InnovationStage other =
      settled(plain, stage.model, noise, Settling::fully, wide(plain.options.threads));
  const double lines_nats = fewer * (kEvidence_nats + kPerParameter_nats * kParametersOfLine);
  if (!(penalised(other) < penalised(stage) + 2.0 * lines_nats)) return {};
  return other;
}

void reconsider_second_mass(const SearchContext& plain, InnovationStage& stage) {
  const SimulationWidth width = wide(plain.options.threads);
  const auto take = [&](InnovationStage other) {
    const bool stays = effect_out_of_range(other).empty() || !effect_out_of_range(stage).empty();
    if (stays && penalised(other) < penalised(stage)) stage = std::move(other);
  };
  for (int round = 0; round < kMostReconsidered && !plain.cancelled(); ++round) {
    const double before = penalised(stage);
    std::vector<ParameterSubset> shares = mass_share_starts(plain, stage.model);
    if (shares.empty()) return;
    take(settled(plain, stage.model, with_force_on_other_mass(stage), Settling::fully, width));
    LikeliestStart other =
        likeliest_start(plain, std::move(shares), stage.noise, plain.options.threads);
    if (!std::isfinite(other.minus_two_log)) return;
    take(settled(plain, model_at(stage.model.added, std::move(other.start)), other.noise,
                 Settling::fully, width));
    // another optimum may be one of several between here and the likeliest
    if (!(penalised(stage) < before - 2.0 * kRivals_nats)) return;
  }
}

bool rings_with_a_line(const InnovationStage& stage, const FreeParameter& p, double theta) {
  if (!p.name.ends_with(kFrequency)) return false;
  const double resonance_Hz = p.to_physical(theta);
  const std::string effect = p.name.substr(0, p.name.size() - kFrequency.size());
  if (value_or(stage.model.fitted, effect + ".damping_ratio", 0.0) > kBroad_ratio) return false;
  return std::any_of(stage.noise.lines.begin(), stage.noise.lines.end(),
                     [&](const auto& line) { return is_on(line, resonance_Hz); });
}

std::optional<LineInstead> line_for_resonance(const SearchContext& plain,
                                              const InnovationStage& stage) {
  const std::string effect = ringing_effect(stage);
  if (effect.empty() || plain.cancelled()) return {};
  const double resonance_Hz = stage.model.fitted.value(effect + std::string(kFrequency));
  LineInstead result;
  result.without = without(plain, stage, effect);
  const std::vector<ScoredLine> lines = line_candidates(plain, result.without);
  const auto on = std::find_if(lines.begin(), lines.end(), [&](const ScoredLine& scored) {
    return is_on(scored.line, resonance_Hz);
  });
  if (on == lines.end()) return {};
  disturbance::NoiseModel noise = result.without.noise;
  noise.lines.push_back(on->line);
  result.stage =
      settled(plain, result.without.model, noise, Settling::fully, wide(plain.options.threads));
  const double penalty = kPerParameter_nats * kParametersOfLine;
  if (!(penalised(result.stage) + 2.0 * penalty < penalised(stage) + 2.0 * kRivals_nats)) return {};
  result.candidate.line = on->line;
  result.candidate.settled = true;
  result.candidate.penalty_nats = penalty;
  result.candidate.gain_nats =
      0.5 * (result.without.minus_two_log - result.stage.minus_two_log) - penalty;
  result.candidate.fitted = result.stage.model.fitted;
  result.candidate.fitted.jacobian.resize(0, 0);
  return result;
}

}  // namespace estimator::greybox::selection
