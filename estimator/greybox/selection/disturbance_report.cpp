#include "estimator/greybox/selection/disturbance_report.h"

#include <algorithm>
#include <cmath>

#include "estimator/greybox/disturbance/simulated_lines.h"
#include "estimator/greybox/disturbance/simulated_noise.h"
#include "estimator/residual/distributions.h"
#include "plant_sim/library.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;

/// A disturbance of less than this share of the sensor's noise, RMS, is none.
constexpr double kSeen = 0.3;
/// Random part over the error of the integration step up to which the step causes it: 1.1 was seen
/// beside dry friction. A quarter of the step shows three quarters of its error at least.
constexpr double kOfStep = 1.5;
/// Share of the random part's square above which it is the walk of the reading.
constexpr double kMostly = 0.5;

struct RecordDisturbance {
  double random_m2 = 0.0;
  double walk_m2 = 0.0;  ///< what the walk of the position alone would cause
  std::vector<disturbance::LineAmplitude> lines;
  double lines_m2 = 0.0;  ///< together; they may break friction loose that each alone does not
};

bool has_dry_friction(const plant_sim::ModelFile& model) {
  const auto& effects = plant_sim::effect_library();
  return std::any_of(effects.begin(), effects.end(), [&](const plant_sim::EffectInfo& effect) {
    return std::find(effect.sites.begin(), effect.sites.end(), "dry_friction") !=
               effect.sites.end() &&
           has_effect(model, effect);
  });
}

/// Mean square (m2) of what the random force, or speed, causes beside dry friction, which holds
/// much of it; none without friction.
std::optional<double> rubbed_m2(const InnovationStage& stage, std::size_t r) {
  const FitSummary& fitted = stage.model.fitted;
  const plant_sim::ModelFile& file = stage.context.problem.model;
  const disturbance::NoiseParameters& noise = stage.noise.noise;
  if (!(noise.disturbance_sd > 0.0) || !has_dry_friction(with_values(file, fitted))) return {};
  const double rms_m = disturbance::simulated_disturbance_rms_m(
      file, stage.context.problem.data.records[r], fitted.parameters, fitted.theta, noise,
      stage.noise.force_place);
  return rms_m * rms_m;
}

RecordDisturbance disturbance_of(const InnovationStage& stage, std::size_t r) {
  const Dataset& record = stage.context.problem.data.records[r];
  RecordDisturbance result;
  const auto caused_m2 = [&](const disturbance::NoiseParameters& noise) {
    const double all_m = disturbance::disturbed_rms_m(stage.linear[r], record, noise);
    return std::max(0.0, all_m * all_m - noise.sensor_m * noise.sensor_m);
  };
  result.random_m2 = caused_m2(stage.noise.noise);
  disturbance::NoiseParameters walk = stage.noise.noise;
  walk.disturbance_sd = 0.0;
  result.walk_m2 = caused_m2(walk);
  if (const std::optional<double> rubbed = rubbed_m2(stage, r)) {
    result.random_m2 = result.walk_m2 + *rubbed;
  }
  std::vector<Eigen::Vector2d> waves;
  for (std::size_t i = 0; i < stage.noise.waves.size(); ++i) {
    waves.push_back(stage.noise.waves[i][r]);
    result.lines.push_back(disturbance::line_amplitude(
        stage.linear[r], record, stage.noise.lines[i], stage.noise.waves[i][r]));
  }
  if (waves.empty()) return result;
  const FitSummary& fitted = stage.model.fitted;
  const Eigen::VectorXd error_m = disturbance::simulated_line_error_m(
      stage.context.problem.model, record, fitted.parameters, fitted.theta, stage.noise.lines,
      waves, stage.noise.force_place);
  double samples = 0.0;
  for (Index k = 0; k < error_m.size(); ++k) {
    if (record.valid[static_cast<std::size_t>(k)] == 0) continue;
    result.lines_m2 += error_m[k] * error_m[k];
    samples += 1.0;
  }
  result.lines_m2 /= std::max(samples, 1.0);
  return result;
}

std::string site_of(const InnovationStage& stage, disturbance::LineSite site) {
  if (site == disturbance::LineSite::force && !stage.linear.front().force) return "speed";
  return disturbance::to_string(site);
}

Candidate candidate_of(const SearchContext& context, const InnovationCandidate& found,
                       const ModelStage& before) {
  Candidate candidate;
  candidate.effects = {found.effect};
  candidate.effects.insert(candidate.effects.end(), found.taken_with_it.begin(),
                           found.taken_with_it.end());
  candidate.fitted_at_all = found.settled;
  if (!found.settled) return candidate;
  candidate.fitted = simulated(context, found.fitted);
  candidate.validation_rms_m = candidate.fitted.validation_rms_m;
  candidate.expected_ratio =
      candidate.validation_rms_m / std::max(before.fitted.validation_rms_m, 1e-300);
  const double raw_nats = std::max(0.0, found.gain_nats + found.penalty_nats);
  candidate.p_value = residual::chi_square_upper(
      2.0 * raw_nats, std::max(1.0, found.penalty_nats / kPerParameter_nats));
  return candidate;
}

}  // namespace

std::optional<Disturbance> disturbance_of(const SearchContext& context,
                                          const InnovationSearch& search) {
  const InnovationStage& stage = search.final;
  if (stage.linear.empty()) return {};
  const FitDataset& data = stage.context.problem.data;
  Disturbance result;
  double random_m2 = 0.0;
  double walk_m2 = 0.0;
  double total_m2 = 0.0;
  double counted = 0.0;
  for (std::size_t r = 0; r < data.records.size(); ++r) {
    const RecordDisturbance one = disturbance_of(stage, r);
    const auto samples = static_cast<double>(data.records[r].size());
    counted += samples;
    random_m2 += samples * one.random_m2;
    walk_m2 += samples * one.walk_m2;
    total_m2 += samples * (one.random_m2 + one.lines_m2);
    result.lines.resize(one.lines.size());
    for (std::size_t i = 0; i < one.lines.size(); ++i) {
      result.lines[i].amplitude += samples * std::pow(one.lines[i].amplitude, 2);
      result.lines[i].rms_m += samples * std::pow(one.lines[i].rms_m, 2);
    }
  }
  for (std::size_t i = 0; i < result.lines.size(); ++i) {
    DisturbanceLine& line = result.lines[i];
    line.as = site_of(stage, stage.noise.lines[i].site);
    line.frequency_Hz = stage.noise.lines[i].frequency_Hz;
    line.amplitude = std::sqrt(line.amplitude / counted);
    line.rms_m = std::sqrt(line.rms_m / counted);
  }
  result.as = site_of(stage, disturbance::LineSite::force);
  const bool seen = std::sqrt(random_m2 / counted) > kSeen * data.noise_floor_m;
  if (seen && walk_m2 > kMostly * random_m2) {
    result.as = "reading";
    result.value = stage.noise.noise.walk_m / std::sqrt(data.sample_time_s);
  } else if (seen) {
    result.value = stage.noise.noise.disturbance_sd;
    result.corner_Hz = stage.noise.noise.corner_Hz;
  }
  result.random_m = std::sqrt(random_m2 / counted);
  result.rms_m = std::sqrt(total_m2 / counted);
  const double error_m =
      rms(simulated(context, stage.model.fitted).residual_m, context.problem.data.all_mask);
  result.share = std::min(1.0, std::pow(result.rms_m / error_m, 2));
  if (!(result.rms_m > kSeen * data.noise_floor_m)) return {};
  return result;
}

void add_line_rivals(const SearchContext& plain, const InnovationStage& final,
                     Disturbance& disturbance) {
  for (std::size_t i = 0; i < disturbance.lines.size(); ++i) {
    for (InnovationStage& other : at_other_sites(plain, final, i)) {
      const double lag = other.minus_two_log - final.minus_two_log;
      if (!(lag < 2.0 * kWorthPolishing_nats)) continue;
      if (lag >= 2.0 * kRivals_nats) {
        other =
            settled(plain, other.model, other.noise, Settling::fully, wide(plain.options.threads));
        if (!(other.minus_two_log < final.minus_two_log + 2.0 * kRivals_nats)) continue;
      }
      double sum = 0.0;
      double counted = 0.0;
      for (std::size_t r = 0; r < other.noise.waves[i].size(); ++r) {
        const auto samples = static_cast<double>(plain.problem.data.records[r].size());
        sum += samples * other.noise.waves[i][r].squaredNorm();
        counted += samples;
      }
      disturbance.lines[i].rivals.push_back(
          {site_of(other, other.noise.lines[i].site), std::sqrt(sum / counted)});
    }
  }
}

void drop_step_error(std::optional<Disturbance>& disturbance, double step_error_m) {
  if (!disturbance || !(disturbance->random_m <= kOfStep * step_error_m)) return;
  if (disturbance->lines.empty()) {
    disturbance.reset();
    return;
  }
  if (disturbance->as == "reading") disturbance->as = "force";  // as where lines alone are seen
  const double lines_m2 = std::pow(disturbance->rms_m, 2) - std::pow(disturbance->random_m, 2);
  disturbance->share *= std::max(0.0, lines_m2) / std::pow(disturbance->rms_m, 2);
  disturbance->rms_m = std::sqrt(std::max(0.0, lines_m2));
  disturbance->random_m = disturbance->value = disturbance->corner_Hz = 0.0;
}

void limit(Disturbance& disturbance, double rms_m) {
  disturbance.rms_m = std::min(disturbance.rms_m, rms_m);
  disturbance.random_m = std::min(disturbance.random_m, disturbance.rms_m);
  for (DisturbanceLine& line : disturbance.lines) line.rms_m = std::min(line.rms_m, rms_m);
}

StructureSearch structure_search_of(const SearchContext& context, const ModelStage& first,
                                    const InnovationSearch& search) {
  ModelStage final{search.final.model.added, simulated(context, search.final.model.fitted)};
  StructureSearch result;
  result.path.push_back(final.added.empty() ? final : first);
  for (const InnovationRound& round : search.rounds) {
    Round one;
    // the model as given is the one that the path begins with
    one.before = round.before.added.empty()
                     ? result.path.front()
                     : ModelStage{round.before.added, simulated(context, round.before.fitted)};
    for (const InnovationCandidate& candidate : round.candidates) {
      if (!candidate.effect.empty())
        one.candidates.push_back(candidate_of(context, candidate, one.before));
    }
    const bool grew = round.before.added.size() > result.path.back().added.size();
    if (grew && !round.before.added.empty()) result.path.push_back(one.before);
    result.rounds.push_back(std::move(one));
  }
  // an effect that was taken and dropped again leaves no step
  std::erase_if(result.path, [&](const ModelStage& stage) {
    return !stage.added.empty() &&
           (stage.added.size() >= final.added.size() ||
            std::any_of(stage.added.begin(), stage.added.end(), [&](const std::string& effect) {
              return std::find(final.added.begin(), final.added.end(), effect) == final.added.end();
            }));
  });
  if (!final.added.empty()) result.path.push_back(final);
  result.final = std::move(final);
  return result;
}

}  // namespace estimator::greybox::selection
