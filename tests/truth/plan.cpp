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

/// Draws an effect into the case; `push` > 1 asks for a stronger one.
void draw_effect(const std::string& name, double push, Case& of, Random& random) {
  Hidden& h = of.hidden;
  const auto size = [&](double typical) { return push * random.around(typical); };
  if (name == "transport_delay") h.delay_s = std::min(0.05, size(0.005));
  if (name == "null_bias") h.null_bias_V = random.sign() * size(0.07);
  if (name == "valve_hysteresis") h.hysteresis_V = std::min(0.6, size(0.15));
  if (name == "deadband") h.deadband_V = std::min(0.8, size(0.2));
  if (name == "flow_asymmetry") h.asymmetry_ratio = random.sign() * std::min(0.3, size(0.04));
  if (name == "supply_droop") h.droop_Pa_per_m3ps = size(1.1e10);
  if (name == "internal_leakage") h.internal_m3ps_per_Pa = size(1.4e-11);
  if (name == "external_leakage") h.external_m3ps_per_Pa = size(6e-13);
  if (name == "entrained_air") h.air_ratio = std::min(0.25, size(0.06));
  if (name == "quadratic_damping") h.quadratic_N_s2_per_m2 = size(1.5e4);
  if (name == "load_force") h.force_N = random.sign() * std::min(900.0, size(250.0));
  if (name == "backlash") h.backlash_m = size(8e-5);
  if (name.rfind("friction", 0) == 0) {
    h.coulomb_N = std::min(500.0, size(150.0));
    if (name != "friction_coulomb") {
      h.static_N = h.coulomb_N * random.uniform(1.2, 1.5);
      h.stribeck_mps = random.uniform(0.008, 0.02);
    }
    if (name == "friction_presliding") h.presliding_N_per_m = random.around(1e6, 1.5);
  }
  if (name == "load_spring") {
    h.spring_N_per_m = std::min(2e4, size(5000.0));
    h.rest_m = random.uniform(0.29, 0.32);
  }
  if (name == "force_ripple") {
    h.ripple_N = std::min(600.0, size(140.0));
    h.ripple_wavelength_m = random.around(0.012, 2.0);
    h.ripple_phase_rad = random.uniform(-3.0, 3.0);
  }
  if (name == "coupled_slaves") {
    h.slaves_kg = std::min(150.0, push * random.around(40.0, 1.5));
    h.slaves_N_s_per_m = random.around(1000.0, 1.5);
    h.needle_N_s2_per_m2 = size(1.2e4);
  }
  if (name == "encoder_eccentricity") {
    h.eccentricity_m = size(4e-5);
    h.eccentricity_wavelength_m = random.around(0.02, 1.8);
    h.eccentricity_phase_rad = random.uniform(-3.0, 3.0);
  }
  // Limits are set so that the motion reaches them.
  if (name == "spool_rate_limit" || name == "flow_saturation") {
    const Record free = simulate(of, 100);
    if (name == "flow_saturation") {
      const double share = std::max(0.3, random.uniform(0.55, 0.85) / push);
      h.flow_limit_m3ps = share * of.plant.area_m2 * free.fastest_mps;
    } else {
      h.spool_rate_mps = std::max(0.2, random.uniform(0.6, 1.2) / push) * free.quick_spool_mps;
    }
  }
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

struct Wanted {
  Names effects;  ///< with the friction variants
  const LeftOutInfo* left_out = nullptr;
  Names motions = kMotions;
  std::size_t first_motion = 0;
  double shows = kShows;
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

Wanted wanted(const std::string& plan, std::size_t index, Random& random) {
  Wanted want;
  want.first_motion = index;
  const bool disturbed = plan == "disturbed";
  if (plan == "single" || disturbed) {
    const std::size_t count = variants().size();
    want.effects = {variants()[index % count]};
    want.first_motion = index / count;
    // Slow motions only reach a rate that would stop the loop from working.
    if (want.effects.front() == "spool_rate_limit" || disturbed) want.motions = kRich;
    if (disturbed) want.shows = kDisturbedShows;
  } else if (plan == "pairs") {
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
  } else if (plan == "leftout") {
    const std::size_t count = left_out_table().size();
    want.left_out = &left_out_table()[index % count];
    want.motions = kRich;
    want.first_motion = index / count + index;
    want.shows = kLeftOutShows;
  } else if (plan != "healthy" && plan != "disturbed_healthy") {
    throw std::invalid_argument(
        "no plan '" + plan +
        "'; there are single, healthy, pairs, leftout, disturbed, disturbed_healthy");
  }
  return want;
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
  }
  return of;
}

/// Which of the disturbances act goes by the record's number.
Outside draw_outside(std::size_t index, Random& random) {
  Outside outside;
  const std::size_t kind = index % 4;
  if (kind != 2) outside.force_N = random.around(28.0, 1.5);
  outside.corner_Hz = random.uniform(1.5, 4.5);
  if (kind == 1 || kind == 2) outside.pulsation_Pa = random.around(1.3e5, 1.6);
  outside.pulsation_Hz = random.uniform(12.0, 38.0);
  if (kind == 3) outside.shake_m = random.around(1e-5, 1.4);
  outside.shake_Hz = random.uniform(25.0, 60.0);
  return outside;
}

Planned answer(const Case& of, Record& record) {
  Planned planned;
  planned.text = to_text(of);
  planned.of = parse_case(planned.text, of.seed);
  planned.hidden = hidden_effects(planned.of.hidden);
  record = simulate(planned.of);
  constexpr double kSpare_Pa = 1e5;
  planned.within_limits = record.least_Pa > kSpare_Pa && record.greatest_ratio < 0.98;
  for (const double y_m : record.reading_m) {
    planned.within_limits = planned.within_limits && y_m > 0.02 && y_m < 0.59;
  }
  for (const std::string& effect : planned.hidden) {
    Case lacking = planned.of;
    lacking.hidden = without(lacking.hidden, effect);
    planned.visibility.push_back(visibility_ratio(lacking, record));
  }
  if (planned.of.left_out.kind != LeftOut::Kind::none) {
    Case lacking = planned.of;
    lacking.left_out = LeftOut{};
    planned.visibility.push_back(visibility_ratio(lacking, record));
  }
  return planned;
}

}  // namespace

const std::vector<std::string>& plans() {
  static const std::vector<std::string> names{"single",  "healthy",   "pairs",
                                              "leftout", "disturbed", "disturbed_healthy"};
  return names;
}

Planned plan_record(const std::string& plan, std::size_t seed, std::size_t index, Record& record) {
  std::size_t salt = 0;
  for (const char c : plan) salt = salt * 131 + static_cast<unsigned char>(c);
  Random random((seed * 1000003U + salt) * 7919U + index);
  Wanted want = wanted(plan, index, random);
  Case of;
  of.seed = seed * 100000 + salt % 997 * 10000 + index + 1;
  of.mismatched = (index + (plan == "single" ? index / variants().size() : 0)) % 2 == 1;
  of.plant = draw_plant(of.seed, of.mismatched);
  if (plan.rfind("disturbed", 0) == 0) {
    of.outside = draw_outside(index + index / variants().size(), random);
  }
  double push = 1.0;
  std::size_t motion = 0;
  Planned best;
  Record best_record;
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
  write_answers(folder + "/answers.json", plan, seed, planned, floors_m);
}

}  // namespace truth
