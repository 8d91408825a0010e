#include "estimator/greybox/selection/confidence.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "estimator/greybox/selection/diagnosis.h"
#include "plant_sim/library.h"

namespace estimator::greybox::selection {
namespace {

constexpr double kStandardErrors = 2.0;
constexpr double kClear = 10.0;
constexpr double kMost = 0.5;

/// How an effect enters the equations, in the words of a Localisation.
std::string site_of(const std::string& effect) {
  const plant_sim::EffectInfo* info = plant_sim::find_effect(effect);
  if (info == nullptr || info->sites.empty()) return "";
  const std::string& site = info->sites.front();
  if (site == "force" || site == "dry_friction" || site == "inertia") return "force";
  if (site == "sensor") return "measurement";
  if (site == "command") return "command";
  return "flow";
}

/// Whether most of the remaining error enters as this effect does: the law there may be another.
bool shares_the_remainder(const Diagnosis& diagnosis, const std::string& effect) {
  return !diagnosis.where.empty() && diagnosis.where.front().site == site_of(effect) &&
         diagnosis.where.front().explained_ratio > kMost;
}

/// Whether an effect, when it was added, explained less than kClear times what is left: by the
/// likelihood, or in mean squared errors.
bool explains_little(const Diagnosis& diagnosis, const std::string& effect) {
  if (diagnosis.by_innovations) {
    const auto gain = diagnosis.gains_nats.find(effect);
    return gain != diagnosis.gains_nats.end() && gain->second < kClear * diagnosis.curve_nats;
  }
  const double left_m2 = std::pow(diagnosis.rms_after_m, 2) - std::pow(diagnosis.noise_floor_m, 2);
  for (std::size_t i = 1; i < diagnosis.steps.size(); ++i) {
    if (diagnosis.steps[i].added.find(effect) == std::string::npos) continue;
    const double explained_m2 = std::pow(diagnosis.steps[i - 1].validation_rms_m, 2) -
                                std::pow(diagnosis.steps[i].validation_rms_m, 2);
    return explained_m2 < kClear * left_m2;
  }
  return false;
}

/// The effect's size, its first parameter, and its rivals.
std::optional<Doubt> doubt_of(const Diagnosis& diagnosis, const std::string& effect) {
  const auto size =
      std::find_if(diagnosis.parameters.begin(), diagnosis.parameters.end(),
                   [&](const ParameterValue& p) { return p.name.rfind(effect + ".", 0) == 0; });
  if (size == diagnosis.parameters.end()) return {};
  if (size->at_bound) return Doubt::at_bound;
  if (!(std::abs(size->value) > kStandardErrors * size->std_error)) return Doubt::within_error;
  for (const auto* groups : {&diagnosis.ambiguous, &diagnosis.same_here}) {
    for (const std::vector<std::string>& group : *groups) {
      if (std::find(group.begin(), group.end(), effect) != group.end()) return Doubt::rivals;
    }
  }
  if (explains_little(diagnosis, effect)) return Doubt::remainder;
  if (shares_the_remainder(diagnosis, effect)) return Doubt::stand_in;
  return {};
}

}  // namespace

const char* to_string(Doubt doubt) {
  switch (doubt) {
    case Doubt::at_bound:
      return "at_bound";
    case Doubt::within_error:
      return "within_error";
    case Doubt::rivals:
      return "rivals";
    case Doubt::remainder:
      return "remainder";
    case Doubt::interrupted:
      return "interrupted";
    case Doubt::stand_in:
      break;
  }
  return "stand_in";
}

std::vector<PossibleEffect> possible_effects(const Diagnosis& diagnosis) {
  std::vector<PossibleEffect> possible;
  if (diagnosis.verdict != Verdict::unexplained) return possible;
  std::vector<std::optional<Doubt>> doubts;
  for (const std::string& effect : diagnosis.missing) doubts.push_back(doubt_of(diagnosis, effect));
  const auto clear =
      static_cast<std::size_t>(std::count(doubts.begin(), doubts.end(), std::nullopt));
  for (std::size_t i = 0; i < doubts.size(); ++i) {
    std::optional<Doubt> doubt = doubts[i];
    if (!doubt && diagnosis.search.interrupted) doubt = Doubt::interrupted;
    if (!doubt && clear >= kStandIn) doubt = Doubt::stand_in;
    if (doubt) possible.push_back({diagnosis.missing[i], *doubt});
  }
  return possible;
}

}  // namespace estimator::greybox::selection
