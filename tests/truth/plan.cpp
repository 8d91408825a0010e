#include "tests/truth/plan.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tests/truth/case.h"
#include "tests/truth/conditions.h"
#include "tests/truth/draw.h"
#include "tests/truth/model_files.h"
#include "tests/truth/visibility.h"

namespace truth {
namespace {

using Names = std::vector<std::string>;

constexpr int kDraws = 8;
constexpr double kShows = 1.8;
constexpr double kLeftOutShows = 3.0;
constexpr double kDisturbedShows = 5.0;

const Names kMotions{"multisine",  "fast_steps", "chirp",    "multisine",  "fast_steps",
                     "slow_steps", "multisine",  "triangle", "fast_steps", "sine"};
const Names kRich{"multisine", "fast_steps", "multisine", "chirp", "fast_steps"};

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

struct Wanted {
  Names effects;  ///< with the friction variants
  const LeftOutInfo* left_out = nullptr;
  Names motions = kMotions;
  std::size_t first_motion = 0;
  double shows = kShows;
  Kind kind = Kind::actuator;
  const Condition* condition = nullptr;
  bool disturbed = false;
  std::size_t which_outside = 0;
  double off_most = 0.0;  ///< every value of the plant up to this; 0: as draw_plant() has it
};

const Names& variants() {
  static const Names names = [] {
    Names found;
    for (const std::string& effect : effects()) {
      if (effect != "friction") found.push_back(effect);
    }
    found.insert(found.end(), {"friction_coulomb", "friction_stribeck", "friction_presliding"});
    return found;
  }();
  return names;
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
  } else {
    want.left_out = &axis_left_out_table().front();
  }
  return want;
}

/// What is named first shows as one of the servo's effects; the rest it cannot have.
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

Wanted wanted(const std::string& plan, std::size_t index, Random& random) {
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

Case draw(const Wanted& want, std::size_t motion, double push, Case of, Random& random) {
  of.motion = want.motions[(want.first_motion + motion) % want.motions.size()];
  for (const std::string& effect : want.effects) draw_effect(effect, push, of, random);
  if (want.left_out != nullptr) {
    of.left_out.kind = want.left_out->kind;
    const bool signed_size = want.left_out->name == "gain_drift" ||
                             want.left_out->name == "null_drift" ||
                             want.left_out->name == "scale_drift";
    of.left_out.size =
        push * random.around(want.left_out->typical) * (signed_size ? random.sign() : 1.0);
    of.left_out.where = random.uniform(want.left_out->where_low, want.left_out->where_high);
    if (of.left_out.kind == LeftOut::Kind::elastic_shaft) {
      // A resonance between 12 and 25 Hz, lower when asked for more; see axis.h.
      const double w = 6.283185307179586 * random.uniform(12.0, 25.0) / push;
      of.left_out.size = w * w * 0.24 * of.axis.mass_kg;
    }
  }
  return of;
}

bool is_within_limits(const Case& of, const Record& record) {
  if (of.kind == Kind::linear_axis || of.kind == Kind::rotary_axis) return true;
  constexpr double kSpare_Pa = 1e5;
  if (record.least_Pa <= kSpare_Pa || record.greatest_ratio >= 0.98) return false;
  return std::all_of(record.reading_m.begin(), record.reading_m.end(),
                     [](double y_m) { return y_m > 0.02 && y_m < 0.59; });
}

Planned answer(const Case& of, Record& record) {
  Planned planned;
  planned.text = to_text(of);
  planned.of = parse_case(planned.text, of.seed);
  planned.hidden = shown_effects(planned.of);
  record = simulate(planned.of);
  planned.within_limits = is_within_limits(planned.of, record);
  for (const std::string& effect : planned.hidden) {
    planned.visibility.push_back(visibility_ratio(lacking(planned.of, effect), record));
  }
  if (planned.of.left_out.kind != LeftOut::Kind::none) {
    Case without_law = planned.of;
    without_law.left_out = LeftOut{};
    planned.visibility.push_back(visibility_ratio(without_law, record));
  }
  return planned;
}

}  // namespace

const std::vector<std::string>& plans() {
  static const std::vector<std::string> names{
      "single", "healthy",    "pairs",       "leftout",    "disturbed",    "disturbed_healthy",
      "axes",   "conditions", "single_rods", "mismatch20", "outside_laws", "repeated"};
  return names;
}

Planned plan_record(const std::string& plan, std::size_t seed, std::size_t index, Record& record) {
  std::size_t salt = 0;
  for (const char c : plan) salt = salt * 131 + static_cast<unsigned char>(c);
  Random random((seed * 1000003U + salt) * 7919U + index);
  Wanted want = wanted(plan, index, random);
  Case of = typical_case(want.kind);
  of.seed = seed * 100000 + salt % 997 * 10000 + index + 1;
  of.mismatched = (index + (plan == "single" ? index / variants().size() : 0)) % 2 == 1;
  if (want.kind != Kind::actuator || want.off_most > 0.0) of.mismatched = false;
  if (want.off_most > 0.0) {
    draw_plant_within(of, want.off_most);
  } else {
    draw_plant(of);
  }
  if (want.kind == Kind::single_rod) of.rod.area_rod_m2 = of.rod.area_cap_m2;  // until asked for
  if (want.condition != nullptr) want.condition->apply(of);
  if (want.disturbed) of.outside = draw_outside(want.kind, want.which_outside, random);
  double push = 1.0;
  std::size_t motion = 0;
  Planned best;
  Record best_record;
  best.condition = want.condition != nullptr ? want.condition->name : "";
  double best_score = -1.0;
  for (int attempt = 0; attempt < kDraws; ++attempt) {
    if (attempt > 0 && plan == "pairs" && attempt % 4 == 0) {
      want = wanted(plan, index, random);
      push = 1.0;
    }
    Planned planned = answer(draw(want, motion, push, of, random), record);
    const double least = planned.visibility.empty() ? want.shows
                                                    : *std::min_element(planned.visibility.begin(),
                                                                        planned.visibility.end());
    const double score = (planned.within_limits ? 10.0 : 0.0) + std::min(least, want.shows);
    if (score > best_score) {
      best_score = score;
      planned.condition = best.condition;
      best = std::move(planned);
      best_record = record;
    }
    if (best_score >= 10.0 + want.shows) break;
    if (best.within_limits && least < want.shows) push *= 1.5;
    if (!best.within_limits) ++motion;
    if (attempt == kDraws / 2) ++motion;
  }
  record = std::move(best_record);
  return best;
}

std::string file_name(std::size_t index) {
  char text[32];
  std::snprintf(text, sizeof text, "case%04zu.csv", index + 1);
  return text;
}

void write_plan(const std::string& plan, std::size_t count, std::size_t seed,
                const std::string& folder, int jobs) {
  std::vector<Planned> planned(count);
  std::vector<double> floors_m(count);
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> done{0};
  std::mutex lock;
  std::string failed;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        Record record;
        planned[i] = plan_record(plan, seed, i, record);
        floors_m[i] = record.floor_m;
        write_csv(record, folder + "/" + file_name(i));
        std::fprintf(stderr, "\r%s %zu of %zu ", plan.c_str(), ++done, count);
      } catch (const std::exception& error) {
        const std::lock_guard guard(lock);
        failed = error.what();
        next = count;
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < jobs; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  std::fputs("\n", stderr);
  if (!failed.empty()) throw std::invalid_argument(failed);
  for (const Planned& one : planned) write_model(one.of.kind, folder);
  write_answers(folder + "/answers.json", plan, seed, planned, floors_m);
}

}  // namespace truth
