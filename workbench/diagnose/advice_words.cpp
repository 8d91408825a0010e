#include "workbench/diagnose/advice_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "plant_sim/library.h"

namespace workbench::diagnose {
namespace {

/// Share of the remaining error's square below which a place says nothing about the cause.
constexpr double kNamesACause = 0.3;

std::string number(double value) { return fmt::format("{:.3g}", value); }

/// True when all of them act at one of the sites.
bool all_at(const plant_sim::ModelFile& model, const std::vector<std::string>& names,
            std::initializer_list<const char*> sites) {
  const std::vector<plant_sim::EffectInfo> effects = plant_sim::effects_of(model);
  return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    return std::any_of(effects.begin(), effects.end(), [&](const plant_sim::EffectInfo& effect) {
      return effect.name == name &&
             std::any_of(effect.sites.begin(), effect.sites.end(), [&](const std::string& site) {
               return std::find(sites.begin(), sites.end(), site) != sites.end();
             });
    });
  });
}

bool any_at(const plant_sim::ModelFile& model, const std::vector<std::string>& names,
            const char* site) {
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return all_at(model, {name}, {site}); });
}

struct Word {
  const char* key;
  const char* words;
};

constexpr std::array kVariables{
    Word{"y", "with the position"},
    Word{"v", "with the velocity"},
    Word{"u", "with the command"},
    Word{"speed", "with the speed"},
    Word{"acceleration", "with the acceleration"},
    Word{"time", "with time"},
    Word{"direction", "with the direction of motion"},
};

constexpr std::array kEnters{
    Word{"flow", "like an offset of the command or a flow"},
    Word{"gain", "like a change of the valve's gain"},
    Word{"force", "like a force"},
    Word{"measurement", "like an error of the position sensor"},
};

constexpr std::array kRecord{
    Word{"flow",
         "record the spool position, or the chamber pressures to tell a leak from the valve"},
    Word{"gain", "record the supply pressure and the spool position"},
    Word{"force", "record the chamber pressures"},
    Word{"measurement", "record the position with a second sensor"},
    Word{"lag",
         "record the spool position or the drive's own speed, which shows a lag ahead of it"},
};

constexpr std::array kDrift{
    Word{"flow", "compare it with the oil's temperature and the valve's null"},
    Word{"gain", "compare it with the supply pressure and the oil's temperature"},
    Word{"force", "ask what was switched or loaded during the record"},
    Word{"measurement", "look for a loose mount or a sensor that warms up"},
};

// The same for an axis that a motor drives: it has no valve and no chambers.
constexpr std::array kAxisEnters{
    Word{"flow", "like an offset of the command"},
    Word{"gain", "like a change of the drive's gain"},
    Word{"force", "like a force"},
    Word{"measurement", "like an error of the position sensor"},
};

constexpr std::array kAxisRecord{
    Word{"flow", "record the motor's current"},
    Word{"gain", "record the motor's current"},
    Word{"force", "record the force with a load cell, or the motor's current"},
    Word{"measurement", "record the position with a second sensor"},
    Word{"lag", "record the motor's own speed, which shows a lag of the drive"},
};

constexpr std::array kAxisDrift{
    Word{"flow", "compare it with the drive's temperature"},
    Word{"gain", "compare it with the drive's supply and temperature"},
    Word{"force", "ask what was switched or loaded during the record"},
    Word{"measurement", "look for a loose mount or a sensor that warms up"},
};

// A servo is known by its speed alone, and moved by a motor or by oil.
constexpr std::array kServoRecord{
    Word{"flow",
         "record the speed that the drive itself measures, with the motor's current or the chamber "
         "pressures"},
    Word{"gain", "record the drive's supply"},
    Word{"force", "record the motor's current or the chamber pressures"},
    Word{"measurement", "record the position with a second sensor"},
    Word{"lag", "record the drive's own speed, which shows a lag ahead of it"},
};

/// Words for a plant by its drive: a valve, a motor or, of a servo, either.
struct Drive {
  const std::array<Word, 4>& enters;
  const std::array<Word, 4>& drift;
  const std::array<Word, 5>& record;
  const char* unlocated;  ///< what to record where nothing tells the place
};

Drive drive_of(const std::string& plant) {
  if (has_site(plant, "set_speed"))
    return {kAxisEnters, kAxisDrift, kServoRecord,
            "the speed that the drive itself measures, with the motor's current or the chamber "
            "pressures."};
  if (has_site(plant, "opening"))
    return {kEnters, kDrift, kRecord, "the chamber pressures and the spool position."};
  return {kAxisEnters, kAxisDrift, kAxisRecord, "the motor's current and the force on the load."};
}

const char* of(const auto& words, const std::string& key) {
  for (const Word& word : words) {
    if (key == word.key) return word.words;
  }
  return "";
}

/// Site of a formula that has the variable; empty where none of the plant's does.
std::string formula_words(const selection::Localisation& where, const std::string& plant) {
  std::string site;
  std::string variable;
  if (where.site == "force") {
    site = "force";
    if (where.variable == "y") variable = "y_m";
    if (where.variable == "v" || where.variable == "speed" || where.variable == "direction") {
      variable = "v_mps";
    }
  } else if (where.site == "measurement") {
    site = "sensor";
    if (where.variable == "y") variable = "y_m";
  } else if (where.variable == "y") {
    site = "opening";
    variable = "y_m";
  } else if (where.variable == "u") {
    site = "command";
    variable = "u_V";
  } else if (where.variable == "v" || where.variable == "speed" || where.variable == "direction") {
    const bool has_opening = has_site(plant, "opening");
    site = has_opening ? "opening" : "force";
    variable = has_opening ? "x_m" : "v_mps";
  }
  if (variable.empty() || !has_site(plant, site)) return "";
  return "or write it as a formula of " + variable + " ([formula_effects.NAME], site = \"" + site +
         "\") and diagnose again";
}

/// Measurements that would tell the sites of a place apart, each once.
std::string words_to_locate(const selection::Localisation& where, const Drive& drive) {
  std::vector<std::string> sites{where.site};
  sites.insert(sites.end(), where.or_sites.begin(), where.or_sites.end());
  std::vector<std::string> measured;
  for (const std::string& site : sites) {
    const std::string words = of(drive.record, site);
    if (std::find(measured.begin(), measured.end(), words) == measured.end()) {
      measured.push_back(words);
    }
  }
  // "A or B" beside "A" asks for A
  const auto is_met_by_another = [&](const std::string& one) {
    return std::any_of(measured.begin(), measured.end(), [&](const std::string& other) {
      const std::size_t what = other.find(' ');
      return other != one && what != std::string::npos &&
             one.find(other.substr(what)) != std::string::npos;
    });
  };
  std::vector<std::string> each;
  std::copy_if(measured.begin(), measured.end(), std::back_inserter(each),
               [&](const std::string& one) { return !is_met_by_another(one); });
  return std::string("For an error that goes ") + of(kVariables, where.variable) +
         " and may enter in several places: " + config::schema::joined(each, "; ") + ".";
}

}  // namespace

bool has_site(const std::string& plant, const std::string& site) {
  const plant_sim::PlantInfo* info = plant_sim::find_plant(plant);
  return info != nullptr &&
         std::find(info->sites.begin(), info->sites.end(), site) != info->sites.end();
}

std::string motion_words(const monitor::control::ReferenceConfig& reference, double duration_s) {
  std::string text;
  if (reference.kind == "multisine") {
    text = "a multisine of " + number(reference.frequencies_Hz.front()) + " to " +
           number(reference.frequencies_Hz.back()) + " Hz";
  } else if (reference.kind == "steps") {
    const bool slow = reference.rise_s < 0.1 * reference.hold_s;
    text = std::string(slow ? "slow steps" : "fast steps") + " every " + number(reference.hold_s) +
           " s, each over " + number(reference.rise_s) + " s,";
  } else if (reference.kind == "chirp") {
    text = "a chirp from " + number(reference.frequency_Hz) + " to " +
           number(reference.frequency_end_Hz) + " Hz";
  } else if (reference.kind == "prbs") {
    text = "a random binary motion (prbs) of " + number(reference.hold_s) + " s a bit";
  } else {
    text = "a sine of " + number(reference.frequency_Hz) + " Hz";
  }
  const std::string mm = config::units::axis_unit("mm");
  return text + " within " + number(1e3 * reference.amplitude_m) + " " + mm + " of " +
         number(1e3 * reference.centre_m) + " " + mm + " for " + number(duration_s) + " s";
}

std::string words_for_motion(const std::vector<std::string>& names, const std::string& motion,
                             double separation, bool tells_others) {
  const std::vector<std::string> others(names.begin() + 1, names.end());
  std::string words = "Run " + motion + ": to take " + names.front() + " for " +
                      config::schema::listed(others, "or") + ", or the reverse, would then leave " +
                      "an error of about " + number(separation) + " times the noise.";
  if (!tells_others) words += " It does not tell " + config::schema::listed(others) + " apart.";
  return words;
}

std::string words_for_sensor(const plant_sim::ModelFile& model,
                             const std::vector<std::string>& names) {
  std::string sensor = "the chamber pressures would";
  if (has_site(model.plant, "set_speed")) {
    sensor = any_at(model, names, "sensor") ? "a second position sensor would"
                                            : "the speed that the drive itself measures would";
  } else if (!has_site(model.plant, "opening")) {
    sensor = any_at(model, names, "sensor") ? "a second position sensor would"
             : any_at(model, names, "force") || any_at(model, names, "dry_friction")
                 ? "a load cell, or the motor's current, would"
                 : "the motor's current would";
  } else if (all_at(model, names, {"command", "amplifier", "spool", "opening", "lap"})) {
    sensor = "the spool position would";
  } else if (all_at(model, names, {"force", "dry_friction", "inertia"})) {
    sensor = "a load cell at the rod would";
  } else if (all_at(model, names, {"edge", "flow", "leakage", "supply", "bulk_modulus"})) {
    sensor = "the chamber pressures and the supply pressure would";
  } else if (any_at(model, names, "sensor")) {
    sensor = "a second position sensor would";
  }
  return "From command and position alone no motion tried tells " + config::schema::listed(names) +
         " apart; " + sensor + ".";
}

std::string words_to_excite(const std::string& motion) {
  return "Run " + motion + ", with the command free of its limits, and diagnose that record.";
}

std::string words_for_leaps() {
  return "Mend the samples that leap out of the motion, or leave them out with --ignore, and "
         "diagnose again: they leave an error that no model explains.";
}

std::string words_for_doubt() {
  return "A longer record, or one with more motion, tells whether it is missing.";
}

std::string words_for_changes(const std::vector<selection::ParameterChange>& changes) {
  const bool between =
      !changes.empty() && std::all_of(changes.begin(), changes.end(),
                                      [](const auto& change) { return !change.record.empty(); });
  if (between) {
    std::vector<std::string> records;
    records.reserve(changes.size());
    for (const selection::ParameterChange& change : changes) records.push_back(change.record);
    std::sort(records.begin(), records.end());
    records.erase(std::unique(records.begin(), records.end()), records.end());
    return "Ask what was switched, loaded or set differently for " +
           config::schema::listed(records) + ", and repeat it with that as it was in the others.";
  }
  return "Ask what was switched, loaded or warmed up during the record, and repeat it with that "
         "held.";
}

std::string words_for_unexplained(const std::vector<selection::Localisation>& where,
                                  const std::string& plant) {
  const Drive drive = drive_of(plant);
  if (where.empty() || where.front().explained_ratio < kNamesACause) {
    return std::string("No effect of the library explains the remaining error; record ") +
           drive.unlocated;
  }
  const selection::Localisation& first = where.front();
  if (!first.or_sites.empty()) return words_to_locate(first, drive);
  std::string text = std::string("For an error that goes ") + of(kVariables, first.variable) +
                     " and enters " + of(drive.enters, first.site) + ": ";
  text += first.variable == "time" ? of(drive.drift, first.site) : of(drive.record, first.site);
  const std::string formula = formula_words(first, plant);
  if (!formula.empty()) text += ", " + formula;
  return text + ".";
}

}  // namespace workbench::diagnose
