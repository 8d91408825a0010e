#include "estimator/greybox/selection/confidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "config/units/quantity.h"
#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/search_chance.h"
#include "plant_sim/library.h"

namespace estimator::greybox::selection {
namespace {

constexpr double kStandardErrors = 2.0;
/// The same where an error remains, which the standard errors take for noise.
constexpr double kStandardErrorsBesideRemainder = 3.0;
constexpr double kMostOfRemainder = 0.5;
/// Probability that the best of all candidates gains by chance as much as an effect beside others,
/// above which this is not established.
constexpr double kChanceOfBest = 0.01;
/// Probability of an effect's gain by chance above which it is not established.
constexpr double kLikelyChance = 0.05;
/// Share of the noise below which the error that an effect removes is small.
constexpr double kSmallShare = 0.25;
/// Squared error that an effect explains over that which remains, above which it is no stand-in.
constexpr double kBeyondDoubt = 100.0;
/// The same where what remains enters as the effect does: a square of the speed in place of the
/// cube leaves 7 % of the error.
constexpr double kBeyondDoubtThere = 400.0;
/// Error over the noise from which on the share explained is no measure: a droop of the supply in
/// place of a flow that is limited one way explains 95 % of the error, and 500 times the noise
/// remains.
constexpr double kNoMeasure_ratio = 100.0;
/// The same with the observer, below which a free run does not count: over a whole record it drifts
/// by what is far below the error that remains.
constexpr double kLeastObserved = 3.0;

/// True where the command is a force: there is no valve in between.
bool is_driven_by_force(const Diagnosis& diagnosis) {
  const plant_sim::PlantInfo* plant = plant_sim::find_plant(diagnosis.better.plant);
  return plant != nullptr &&
         std::find(plant->sites.begin(), plant->sites.end(), "opening") == plant->sites.end();
}

/// Entry of an effect into the equations, in the words of a Localisation.
std::string site_of(const Diagnosis& diagnosis, const std::string& effect) {
  const plant_sim::EffectInfo* info = plant_sim::find_effect(effect);
  if (info == nullptr || info->sites.empty()) return "";
  const std::string& site = info->sites.front();
  if (site == "force" || site == "dry_friction" || site == "inertia" || site == "coupling") {
    return "force";
  }
  if (site == "sensor") return "measurement";
  if (site == "lag") return site;
  if (site == "command" || site == "amplifier" || site == "drive")
    return is_driven_by_force(diagnosis) ? "force" : "command";
  return "flow";
}

/// Command, flow and gain are one: each changes what flows.
bool is_same_site(const std::string& one, const std::string& other) {
  const auto is_flow = [](const std::string& site) {
    return site == "flow" || site == "gain" || site == "command";
  };
  return one == other || (is_flow(one) && is_flow(other));
}

/// True for a lag beside which another one may be what is missing.
bool may_be_another_lag(const Localisation& where, const std::string& effect) {
  return (effect == "transport_delay" || effect == "drive_lag" || effect == "second_order_lag") &&
         std::find(where.or_sites.begin(), where.or_sites.end(), "lag") != where.or_sites.end();
}

/// True when most of the remaining error enters as this effect does: the law there may be another,
/// or an offset may drift in time.
bool shares_the_remainder(const Diagnosis& diagnosis, const std::string& effect) {
  if (diagnosis.where.empty()) return false;
  const Localisation& where = diagnosis.where.front();
  const std::string site = site_of(diagnosis, effect);
  return where.explained_ratio > kMostOfRemainder &&
         (where.site == site || may_be_another_lag(where, effect) ||
          (where.variable == "time" && effect == "null_bias" && is_same_site(where.site, site)));
}

/// Number of the step that adds an effect, alone or joined to others by " + "; 0: none does.
std::size_t step_of(const Diagnosis& diagnosis, const std::string& effect) {
  for (std::size_t i = 1; i < diagnosis.steps.size(); ++i) {
    const std::string all = " + " + diagnosis.steps[i].added + " + ";
    if (all.find(" + " + effect + " + ") != std::string::npos) return i;
  }
  return 0;
}

/// Squared error that a step removed from simulations.
double removed_m2(const Diagnosis& diagnosis, std::size_t step) {
  return std::pow(diagnosis.steps[step - 1].validation_rms_m, 2) -
         std::pow(diagnosis.steps[step].validation_rms_m, 2);
}

/// Squared error of simulations that an effect explains, over that which remains, with the observer
/// or in a free run; NaN where not known.
double simulated_ratio(const Diagnosis& diagnosis, const std::string& effect) {
  const auto explained_ratio = [&](double without_m, double with_m, double after_m) {
    const double left_m2 = std::pow(after_m, 2) - std::pow(diagnosis.noise_floor_m, 2);
    return (std::pow(without_m, 2) - std::pow(with_m, 2)) / std::max(left_m2, 0.0);
  };
  double observed = std::nan("");
  double free_run = std::nan("");
  if (const std::size_t i = step_of(diagnosis, effect); i > 0) {
    const SelectionStep& with = diagnosis.steps[i];
    const SelectionStep& without = diagnosis.steps[i - 1];
    observed =
        explained_ratio(without.validation_rms_m, with.validation_rms_m, diagnosis.rms_after_m);
    free_run = explained_ratio(without.free_run_rms_m, with.free_run_rms_m,
                               diagnosis.steps.back().free_run_rms_m);
  }
  if (const auto without = diagnosis.without_rms_m.find(effect);
      without != diagnosis.without_rms_m.end()) {
    observed = explained_ratio(without->second, diagnosis.rms_after_m, diagnosis.rms_after_m);
  }
  if (observed < kLeastObserved) return observed;
  return std::fmax(observed, free_run);  // a NaN gives the other
}

/// The same by the likelihood, where it decided; otherwise that of simulations.
double likely_ratio(const Diagnosis& diagnosis, const std::string& effect) {
  const auto gain = diagnosis.gains_nats.find(effect);
  return gain == diagnosis.gains_nats.end()
             ? simulated_ratio(diagnosis, effect)
             : explained_ratio(gain->second, diagnosis.curve_nats, diagnosis.innovations);
}

bool is_beyond_doubt(const Diagnosis& diagnosis, const std::string& effect) {
  const double simulated = simulated_ratio(diagnosis, effect);
  if (shares_the_remainder(diagnosis, effect)) {
    return simulated > kBeyondDoubtThere &&
           diagnosis.rms_after_m < kNoMeasure_ratio * diagnosis.noise_floor_m;
  }
  return simulated > kBeyondDoubt || likely_ratio(diagnosis, effect) > kBeyondDoubt;
}

/// True for an effect that by itself explained nearly all before a law came near to the rest: what
/// came in with it or after it counts neither for it nor against what remains.
bool is_beyond_doubt_without_laws(const Diagnosis& diagnosis, const std::string& effect) {
  std::size_t law = diagnosis.steps.size();
  for (const Law& one : diagnosis.laws) law = std::min(law, step_of(diagnosis, one.effect.name));
  const std::size_t step = step_of(diagnosis, effect);
  if (step == 0 || step >= law || diagnosis.steps[step].added != effect) return false;
  const double left_m = diagnosis.steps[step].validation_rms_m;
  const double floor_m = diagnosis.noise_floor_m;
  return left_m > floor_m && left_m < kNoMeasure_ratio * floor_m &&
         removed_m2(diagnosis, step) >
             kBeyondDoubtThere * (std::pow(left_m, 2) - std::pow(floor_m, 2));
}

/// True when a curve that enters elsewhere explains as much as all effects together.
bool is_matched_elsewhere(const Diagnosis& diagnosis, const std::string& effect) {
  if (diagnosis.whole.empty()) return false;
  const Localisation& curve = diagnosis.whole.front();
  if (is_same_site(curve.site, site_of(diagnosis, effect))) return false;
  const double left_ratio = std::pow(diagnosis.rms_after_m / diagnosis.rms_before_m, 2);
  return 1.0 - curve.explained_ratio < left_ratio;
}

double least_standard_errors(const Diagnosis& diagnosis) {
  return diagnosis.verdict == Verdict::unexplained ? kStandardErrorsBesideRemainder
                                                   : kStandardErrors;
}

bool is_clear_of_error(const ParameterValue& p, double standard_errors) {
  return !p.at_bound && std::abs(p.value) > standard_errors * p.std_error;
}

/// True for two numbers of one quantity; two ratios are two quantities.
bool shares_unit(const ParameterValue& one, const ParameterValue& other) {
  const std::string unit = config::units::unit_of(one.name);
  return one.name == other.name || (!unit.empty() && config::units::unit_of(other.name) == unit);
}

bool has(const std::vector<std::string>& effects, const std::string& effect) {
  return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

/// True for a parameter that came in with the effect; the model file may have others of it.
bool is_of_added(const std::string& effect, const ParameterValue& p) {
  return !p.in_model && p.name.rfind(effect + ".", 0) == 0;
}

/// True for a refinement of an effect. Every parameter of a formula counts as one: a curve has
/// several values of one unit, of which the first may well be zero.
bool is_refinement(const std::string& effect, const ParameterValue& p) {
  const plant_sim::EffectInfo* info = plant_sim::find_effect(effect);
  if (info == nullptr) return true;
  return std::any_of(info->parameters.begin(), info->parameters.end(), [&](const auto& own) {
    return own.refinement > 0 && p.name == effect + "." + own.name;
  });
}

/// Doubt by the effect's size, its first parameter. Where that is zero or within its error, a
/// refinement in its unit may be clear: friction at rest, of which a record cannot tell how far it
/// falls while it slides. Of an effect that the model has, any refinement may be what is missing.
std::optional<Doubt> doubt_of_size(const Diagnosis& diagnosis, const std::string& effect) {
  const auto is_own = [&](const ParameterValue& p) { return is_of_added(effect, p); };
  const double least = least_standard_errors(diagnosis);
  const auto size = std::find_if(diagnosis.parameters.begin(), diagnosis.parameters.end(), is_own);
  const bool in_file = diagnosis.is_in_file(effect);
  if (size == diagnosis.parameters.end() && in_file) return Doubt::within_error;
  if (size == diagnosis.parameters.end() || is_clear_of_error(*size, least)) return {};
  const bool refined = (size->value == 0.0 || !size->at_bound) &&
                       std::any_of(size, diagnosis.parameters.end(), [&](const auto& p) {
                         return is_own(p) && is_refinement(effect, p) &&
                                (in_file || shares_unit(*size, p)) && is_clear_of_error(p, least);
                       });
  if (refined) return {};
  return size->at_bound ? Doubt::at_bound : Doubt::within_error;
}

/// True where a number of an effect in the unit of its size is at the greatest that it can be:
/// friction that holds 30 times what the rig can push stands for something else.
bool is_beyond_sense(const Diagnosis& diagnosis, const std::string& effect) {
  const auto is_own = [&](const ParameterValue& p) { return is_of_added(effect, p); };
  const auto size = std::find_if(diagnosis.parameters.begin(), diagnosis.parameters.end(), is_own);
  if (size == diagnosis.parameters.end()) return false;
  return std::any_of(size, diagnosis.parameters.end(), [&](const auto& p) {
    return is_own(p) && shares_unit(*size, p) && p.at_bound && p.value != 0.0;
  });
}

/// True where noise explained the model without the effect, which removed little: it may make up
/// for any of the plant's laws that the model has not quite right.
bool is_below_noise(const Diagnosis& diagnosis, const std::string& effect) {
  const std::size_t i = step_of(diagnosis, effect);
  return i > 0 &&
         diagnosis.steps[i - 1].validation_rms_m <= kUnexplained * diagnosis.noise_floor_m &&
         removed_m2(diagnosis, i) < std::pow(kSmallShare * diagnosis.noise_floor_m, 2);
}

/// True for an effect beside others that removes less than the noise, where the best of all that
/// were tried may do so by chance.
bool may_be_best_by_chance(const Diagnosis& diagnosis, const std::string& effect) {
  const std::size_t i = step_of(diagnosis, effect);
  return !diagnosis.by_innovations && diagnosis.missing.size() > 1 && i > 0 &&
         removed_m2(diagnosis, i) < std::pow(diagnosis.noise_floor_m, 2) &&
         chance_of(diagnosis.search, effect).p_best_of_all > kChanceOfBest;
}

/// True where another effect, which gained more than chance does, left clearly less than this one
/// in a round and was dropped later: either may stand in the other's place.
bool is_outdone(const Diagnosis& diagnosis, const std::string& effect) {
  const std::vector<Round>& rounds = diagnosis.search.rounds;
  const auto is_dropped = [&](const std::string& other) {
    return !has(diagnosis.missing, other) &&
           std::any_of(rounds.begin(), rounds.end(),
                       [&](const Round& round) { return has(round.before.added, other); });
  };
  return std::any_of(rounds.begin(), rounds.end(), [&](const Round& round) {
    const auto& tried = round.candidates;
    const auto own = std::find_if(tried.begin(), tried.end(), [&](const Candidate& one) {
      return one.fitted_at_all && one.effects == std::vector{effect};
    });
    if (own == tried.end()) return false;
    return std::any_of(tried.begin(), tried.end(), [&](const Candidate& other) {
      return other.fitted_at_all && other.effects.size() == 1 &&
             other.validation_rms_m < (1.0 - kRivals) * own->validation_rms_m &&
             other.p_value < kLikelyChance && is_dropped(other.effects.front());
    });
  });
}

/// True where two or more parameters of the plant are fitted and all of them are at their bounds,
/// or, where an error remains, most of three or more: the plant is another, or bends to make up for
/// what is missing.
bool is_another_plant(const Diagnosis& diagnosis) {
  std::size_t count = 0;
  std::size_t at_bound = 0;
  for (const ParameterValue& p : diagnosis.parameters) {
    if (p.name.find('.') != std::string::npos) continue;
    ++count;
    if (p.at_bound) ++at_bound;
  }
  const bool error_remains = diagnosis.verdict == Verdict::unexplained;
  return count > 1 &&
         (at_bound == count || (error_remains && at_bound > 2 && 2 * at_bound > count));
}

/// True where several of the plant's parameters had to be moved to their bounds, and more than the
/// noise is left, or the effect has made a simulation no better: it may share with them what
/// another law does.
bool is_strained(const Diagnosis& diagnosis, const std::string& effect) {
  constexpr double kAtNoise = 1.05;
  const auto is_bent = [](const ParameterValue& p) {
    return p.name.find('.') == std::string::npos && p.at_bound && p.value != 0.0;
  };
  const auto& all = diagnosis.parameters;
  if (std::count_if(all.begin(), all.end(), is_bent) < 2) return false;
  const std::size_t i = step_of(diagnosis, effect);
  return diagnosis.rms_after_m > kAtNoise * diagnosis.floor_m() ||
         (i > 0 && diagnosis.steps[i].validation_rms_m >= diagnosis.steps[i - 1].validation_rms_m);
}

/// Doubt by the error that remains: the effect's rivals, and how much it explains.
std::optional<Doubt> doubt_of_remainder(const Diagnosis& diagnosis, const std::string& effect) {
  for (const std::vector<std::string>& group : diagnosis.ambiguous) {
    if (has(group, effect)) return Doubt::rivals;
  }
  if (is_matched_elsewhere(diagnosis, effect)) return Doubt::stand_in;
  const bool likely_chance =
      !diagnosis.by_innovations && chance_of(diagnosis.search, effect).p_value > kLikelyChance;
  // a free run without an offset drifts, whichever effect of several stops it
  if (likely_chance && is_outdone(diagnosis, effect)) return Doubt::chance;
  if (is_beyond_doubt(diagnosis, effect)) return {};
  if (likely_chance) return Doubt::chance;
  if (!is_clear_of_remainder(diagnosis, effect)) return Doubt::remainder;
  if (shares_the_remainder(diagnosis, effect)) return Doubt::stand_in;
  return {};
}

}  // namespace

double explained_ratio(double gain_nats, double curve_nats, double innovations) {
  if (!(curve_nats > 0.0)) return std::numeric_limits<double>::infinity();
  const double nats = 0.5 * innovations;
  return std::expm1(gain_nats / nats) / (curve_nats / nats);
}

bool is_clear_of_remainder(const Diagnosis& diagnosis, const std::string& effect) {
  return !(likely_ratio(diagnosis, effect) < kClearOfRemainder) ||
         simulated_ratio(diagnosis, effect) >= kClearOfRemainder;
}

std::vector<PossibleEffect> possible_effects(const Diagnosis& diagnosis) {
  const bool error_remains = diagnosis.verdict == Verdict::unexplained;
  std::vector<std::optional<Doubt>> doubts;
  for (const std::string& effect : diagnosis.missing) {
    std::optional<Doubt> doubt = doubt_of_size(diagnosis, effect);
    // beside a law that only comes near, an effect may make up for what it lacks
    if (!doubt && error_remains && !diagnosis.laws.empty() &&
        !is_beyond_doubt_without_laws(diagnosis, effect)) {
      doubt = Doubt::stand_in;
    }
    if (!doubt && is_another_plant(diagnosis)) doubt = Doubt::stand_in;
    if (!doubt && error_remains && is_beyond_sense(diagnosis, effect)) doubt = Doubt::at_bound;
    if (!doubt && error_remains) doubt = doubt_of_remainder(diagnosis, effect);
    if (!doubt && diagnosis.undriven.contains(effect)) doubt = Doubt::undriven;
    if (!doubt && !error_remains && is_strained(diagnosis, effect)) doubt = Doubt::strained;
    if (!doubt && !error_remains && is_below_noise(diagnosis, effect)) doubt = Doubt::below_noise;
    if (!doubt && !error_remains && may_be_best_by_chance(diagnosis, effect)) {
      doubt = Doubt::chance;
    }
    // one of several that gains little more than the curves that noise allows
    if (!doubt && !error_remains && diagnosis.missing.size() >= kStandIn &&
        likely_ratio(diagnosis, effect) < kClearOfRemainder && diagnosis.gains_nats.count(effect)) {
      doubt = Doubt::stand_in;
    }
    doubts.push_back(doubt);
  }
  const auto clear =
      static_cast<std::size_t>(std::count(doubts.begin(), doubts.end(), std::nullopt));
  std::vector<PossibleEffect> possible;
  for (std::size_t i = 0; i < doubts.size(); ++i) {
    std::optional<Doubt> doubt = doubts[i];
    if (!doubt && error_remains && diagnosis.search.interrupted) doubt = Doubt::interrupted;
    if (!doubt && error_remains && diagnosis.fits_another_plant()) doubt = Doubt::stand_in;
    if (!doubt && error_remains && clear >= kStandIn &&
        !is_beyond_doubt(diagnosis, diagnosis.missing[i])) {
      doubt = Doubt::stand_in;
    }
    if (doubt) possible.push_back({diagnosis.missing[i], *doubt});
  }
  return possible;
}

void weigh_doubts(Diagnosis& diagnosis) {
  diagnosis.possible = possible_effects(diagnosis);
  if (diagnosis.verdict == Verdict::missing && diagnosis.established().empty()) {
    diagnosis.verdict = Verdict::undetermined;
  }
  const auto is_doubted = [&](const Law& law) {
    return std::any_of(diagnosis.possible.begin(), diagnosis.possible.end(),
                       [&](const PossibleEffect& one) { return one.effect == law.effect.name; });
  };
  if (diagnosis.verdict == Verdict::learned &&
      std::any_of(diagnosis.laws.begin(), diagnosis.laws.end(), is_doubted)) {
    const bool at_floor = diagnosis.rms_after_m <= kUnexplained * diagnosis.floor_m();
    diagnosis.verdict = at_floor ? Verdict::undetermined : Verdict::unexplained;
    diagnosis.possible = possible_effects(diagnosis);
  }
}

}  // namespace estimator::greybox::selection
