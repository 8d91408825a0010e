#include "tests/truth/wanted.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "tests/truth/plan.h"
#include "tests/truth/shown.h"

namespace truth {
namespace {

using Names = std::vector<std::string>;

constexpr double kLeftOutShows = 3.0;
constexpr double kDisturbedShows = 5.0;

const Names kRich{"multisine", "fast_steps", "multisine", "chirp", "fast_steps"};

const Names& variants() {
  static const Names names = [] {
    Names found;
    for (const std::string& effect : effects()) {
      // the plan of axes draws them
      const bool is_of_axes = effect == "drive_lag" || effect == "drive_saturation";
      if (effect != "friction" && !is_of_axes) found.push_back(effect);
    }
    found.insert(found.end(), {"friction_coulomb", "friction_stribeck", "friction_presliding"});
    return found;
  }();
  return names;
}

const std::map<std::string, std::string>& classes() {
  static const std::map<std::string, std::string> of{
      {"transport_delay", "command"},  {"null_bias", "command"},
      {"valve_hysteresis", "command"}, {"spool_rate_limit", "valve"},
      {"deadband", "valve"},           {"flow_asymmetry", "valve"},
      {"flow_saturation", "valve"},    {"supply_droop", "supply"},
      {"internal_leakage", "leakage"}, {"external_leakage", "leakage"},
      {"entrained_air", "oil"},        {"friction_coulomb", "force"},
      {"friction_stribeck", "force"},  {"quadratic_damping", "force"},
      {"load_spring", "force"},        {"load_force", "force"},
      {"force_ripple", "force"},       {"coupled_slaves", "force"},
      {"backlash", "sensor"},          {"encoder_eccentricity", "sensor"},
  };
  return of;
}

/// Pairs that a record hardly tells from one of the two alone or from another pair.
bool rivals(const std::string& a, const std::string& b) {
  static const std::vector<std::pair<std::string, std::string>> known{
      {"flow_asymmetry", "load_force"},
      {"transport_delay", "internal_leakage"},
      {"transport_delay", "spool_rate_limit"},
      {"transport_delay", "entrained_air"},
      {"internal_leakage", "entrained_air"},
      {"external_leakage", "entrained_air"},
      {"friction", "backlash"},
      {"valve_hysteresis", "backlash"},
      {"quadratic_damping", "supply_droop"},
      {"coupled_slaves", "supply_droop"},
      {"quadratic_damping", "flow_saturation"},
      {"coupled_slaves", "flow_saturation"},
      {"supply_droop", "flow_saturation"},
      {"coupled_slaves", "entrained_air"},
  };
  return std::any_of(known.begin(), known.end(), [&](const auto& pair) {
    return (a.rfind(pair.first, 0) == 0 && b.rfind(pair.second, 0) == 0) ||
           (b.rfind(pair.first, 0) == 0 && a.rfind(pair.second, 0) == 0);
  });
}

/// The effect, or none, that stands at a place of the row of singles with three healthy records.
Names single_or_none(std::size_t place) {
  return place < variants().size() ? Names{variants()[place]} : Names{};
}
constexpr std::size_t kHealthyPlaces = 3;

Wanted disturbed_single(std::size_t index) {
  Wanted want;
  const std::size_t count = variants().size();
  want.effects = {variants()[index % count]};
  want.first_motion = index / count;
  want.motions = kRich;
  want.shows = kDisturbedShows;
  want.disturbed = true;
  want.which_outside = index + index / count;
  return want;
}

Wanted pair(std::size_t index, Random& random) {
  Wanted want;
  want.first_motion = index;
  Names all;
  for (const auto& [name, of] : classes()) all.push_back(name);
  std::string a;
  std::string b;
  do {
    a = all[random.below(all.size())];
    b = all[random.below(all.size())];
  } while (classes().at(a) == classes().at(b) || rivals(a, b));
  want.effects = {a, b};
  want.motions = kRich;
  return want;
}

/// Under a condition the singles are walked through by a stride without a common divisor.
Wanted under_condition(std::size_t index) {
  const std::size_t count = variants().size() + kHealthyPlaces;
  const std::size_t round = index / conditions().size();
  const std::size_t place = index % conditions().size();
  Wanted want;
  want.condition = &conditions()[place];
  want.effects = single_or_none((5 * round + 7 * place) % count);
  want.motions = want.condition->motions.empty() ? kRich : want.condition->motions;
  want.first_motion = round;
  return want;
}

Wanted left_out_one(std::size_t index) {
  Wanted want;
  const std::size_t count = left_out_table().size();
  want.left_out = &left_out_table()[index % count];
  want.motions = kRich;
  want.first_motion = index / count + index;
  want.shows = kLeftOutShows;
  return want;
}

Wanted repeated(std::size_t index) {
  const std::size_t count = variants().size() + kHealthyPlaces;
  Wanted want = disturbed_single(index);
  want.effects = single_or_none((index * 7) % count);
  want.which_outside = index + index / count;
  want.condition = &repeating();
  want.first_motion = index / count + index;
  return want;
}

/// Twelve by turns: undisturbed, disturbed, then the same with linear and rotary exchanged.
Wanted on_axis(std::size_t index) {
  static const std::vector<Names> turns{{"friction_coulomb"},
                                        {"force_ripple"},
                                        {"friction_stribeck"},
                                        {"backlash"},
                                        {"load_spring"},
                                        {"transport_delay"},
                                        {},
                                        {"friction_presliding"},
                                        {"load_force"},
                                        {"encoder_eccentricity"},
                                        {"quadratic_damping"}};
  static const std::vector<Names> pairs{{"friction_stribeck", "force_ripple"},
                                        {"friction_coulomb", "load_force"},
                                        {"friction_coulomb", "load_spring"},
                                        {"friction_stribeck", "transport_delay"}};
  static const std::vector<Names> drives{{"drive_saturation"}, {"drive_lag"}};
  const std::size_t turn = index % 12;
  const std::size_t round = index / 12;
  Wanted want;
  want.kind = (turn + round / 2) % 2 == 0 ? Kind::linear_axis : Kind::rotary_axis;
  want.disturbed = round % 2 == 1;
  want.which_outside = turn + round / 2;
  want.shows = kDisturbedShows;
  want.motions = kRich;
  want.first_motion = index + round;
  if (turn < turns.size()) {
    want.effects = turns[turn];
  } else if (round % 4 < 2) {
    want.effects = pairs[(round % 2 + round / 4 * 2) % pairs.size()];
  } else if (round % 8 > 5) {
    want.effects = drives[round % 2];
  } else {
    want.left_out = &axis_left_out_table().front();
  }
  return want;
}

/// The first name is the servo's effect that shows; the others it cannot have.
Wanted on_rod(std::size_t index) {
  static const std::vector<Names> turns{{"flow_asymmetry", "deadband"},
                                        {"flow_asymmetry"},
                                        {"deadband"},
                                        {"flow_asymmetry", "deadband", "supply_droop"},
                                        {"flow_asymmetry", "null_bias"},
                                        {"flow_asymmetry", "friction"},
                                        {"flow_asymmetry", "deadband", "null_bias"},
                                        {},
                                        {"flow_asymmetry", "deadband", "friction"},
                                        {"flow_asymmetry", "valve_hysteresis"},
                                        {"flow_asymmetry", "deadband", "load_force"},
                                        {"flow_asymmetry", "transport_delay"}};
  const std::size_t round = index / turns.size();
  Wanted want;
  want.kind = Kind::single_rod;
  want.effects = turns[index % turns.size()];
  want.motions = kRich;
  want.first_motion = index + round;
  want.shows = kDisturbedShows;
  want.disturbed = round % 2 == 1;
  want.which_outside = index + round / 2;
  return want;
}

/// Without what goes by the record's number alone.
Wanted of_plan(const std::string& plan, std::size_t index, Random& random) {
  Wanted want;
  want.first_motion = index;
  if (plan == "healthy" || plan == "disturbed_healthy") {
    want.disturbed = plan == "disturbed_healthy";
    want.which_outside = index + index / variants().size();
    return want;
  }
  if (plan == "single" || plan == "mismatch20") {
    const std::size_t count = variants().size();
    want.effects = {variants()[index % count]};
    want.first_motion = index / count;
    // Slow motions only reach a rate that would stop the loop from working.
    if (want.effects.front() == "spool_rate_limit") want.motions = kRich;
    if (plan == "mismatch20") want.off_most = 0.2;
    return want;
  }
  if (plan == "disturbed") return disturbed_single(index);
  if (plan == "pairs") return pair(index, random);
  if (plan == "leftout") return left_out_one(index);
  if (plan == "outside_laws") {
    want = left_out_one(index);
    want.disturbed = true;
    want.which_outside = index + index / left_out_table().size();
    want.shows = 2.0 * kDisturbedShows;
    return want;
  }
  if (plan == "conditions") return under_condition(index);
  if (plan == "repeated") return repeated(index);
  if (plan == "axes") return on_axis(index);
  if (plan == "single_rods") return on_rod(index);
  std::string known;
  for (const std::string& name : plans()) known += (known.empty() ? "" : ", ") + name;
  throw std::invalid_argument("no plan '" + plan + "'; there are " + known);
}

}  // namespace

const std::vector<std::string>& mixed_motions() {
  static const Names names{"multisine",  "fast_steps", "chirp",    "multisine",  "fast_steps",
                           "slow_steps", "multisine",  "triangle", "fast_steps", "sine"};
  return names;
}

const std::vector<std::string>& plans() {
  static const std::vector<std::string> names{
      "single", "healthy",    "pairs",       "leftout",    "disturbed",    "disturbed_healthy",
      "axes",   "conditions", "single_rods", "mismatch20", "outside_laws", "repeated"};
  return names;
}

Wanted wanted(const std::string& plan, std::size_t index, Random& random) {
  Wanted want = of_plan(plan, index, random);
  const std::size_t round = plan == "single" ? index / variants().size() : 0;
  want.mismatched = want.kind == Kind::actuator && want.off_most == 0.0 && (index + round) % 2 == 1;
  return want;
}

}  // namespace truth
