#include "estimator/greybox/tracking/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/units/quantity.h"

namespace estimator::greybox::tracking {
namespace {

using Eigen::Index;

/// Cosine above which it is another parameter that hides one.
constexpr double kAlike = 0.98;

std::string percent(double ratio) { return fmt::format("{:.3g} %", 100.0 * ratio); }

bool is_logarithmic(const FreeParameter& p) { return p.scale == Scale::logarithmic; }

/// "12 %" of the value, or "0.3 times its typical size".
std::string error_words(const FreeParameter& p, double std_error) {
  if (!std::isfinite(std_error)) return "not at all";
  return is_logarithmic(p) ? "to +- " + percent(std_error) + " only"
                           : fmt::format("to +- {:.2g} of its typical size only", std_error);
}

/// Whose effect is most like that of parameter `at`; -1: there is no other.
Index alike(const Eigen::MatrixXd& likeness, Index at) {
  Index best = -1;
  for (Index j = 0; j < likeness.cols(); ++j) {
    if (j == at) continue;
    if (best < 0 || std::abs(likeness(at, j)) > std::abs(likeness(at, best))) best = j;
  }
  return best;
}

std::string pressure_words(double value_Pa) {
  return config::units::words(config::units::quantity("pressure_Pa", value_Pa, NAN));
}

/// How often a chamber's error is its limit, and its offset that of offsets.
struct Beyond {
  double error = 0.0;
  double offset = 0.0;

  [[nodiscard]] double most() const { return std::max(error, offset); }
};

Beyond beyond(const ChamberFit& found, const ChamberError& baseline, double offset_sd_Pa,
              double most_ratio) {
  return {found.rms_Pa / (most_ratio * baseline.rms_Pa),
          std::abs(found.mean_Pa) / (kMostOffset * offset_sd_Pa)};
}

std::string chamber_words(const std::string& name, const ChamberFit& found,
                          const ChamberError& baseline, double offset_sd_Pa, double most_ratio) {
  const Beyond by = beyond(found, baseline, offset_sd_Pa, most_ratio);
  if (by.error >= by.offset) {
    return "the model does not explain the " + name + ": error " + pressure_words(found.rms_Pa) +
           ", healthy " + pressure_words(baseline.rms_Pa) +
           fmt::format(", limit {:.3g} times that", most_ratio);
  }
  return "the " + name + " is off the model: by " + pressure_words(found.mean_Pa) +
         " from when it was healthy, limit " + pressure_words(kMostOffset * offset_sd_Pa);
}

}  // namespace

std::string name_words(const std::string& name) {
  if (name.find('.') != std::string::npos) {
    std::string effect = name.substr(0, name.find('.'));
    std::replace(effect.begin(), effect.end(), '_', ' ');
    return effect;
  }
  return config::units::parameter_words(name);
}

std::string value_words(const FreeParameter& p, double theta, double std_error) {
  return config::units::words(
      config::units::quantity(p.name, p.to_physical(theta), std_error * p.slope(theta)));
}

std::string still_words(double moved_m, double noise_floor_m, double window_s) {
  return fmt::format("no motion: within {:.3g} s the rod moves ", window_s) +
         config::units::length_words(moved_m) + ", the position's noise is " +
         config::units::length_words(noise_floor_m);
}

std::string misfit_words(const WindowFitSummary& found, const ErrorScales& baseline,
                         double most_ratio) {
  if (found.rms_m > most_ratio * baseline.rms_m) {
    return "the model does not explain it: error " + config::units::length_words(found.rms_m) +
           ", healthy " + config::units::length_words(baseline.rms_m) +
           fmt::format(", limit {:.3g} times that", most_ratio);
  }
  if (!found.with_chambers()) return {};
  const ChamberErrors& chambers = baseline.chambers;
  const double sd_Pa = chambers.offset_sd_Pa;
  const double in = beyond(found.in, chambers.in, sd_Pa, most_ratio).most();
  const double out = beyond(found.out, chambers.out, sd_Pa, most_ratio).most();
  if (in <= 1.0 && out <= 1.0) return {};
  return in >= out ? chamber_words("pressure in", found.in, chambers.in, sd_Pa, most_ratio)
                   : chamber_words("pressure out", found.out, chambers.out, sd_Pa, most_ratio);
}

std::string unseen_words(const ParameterSet& set, const WindowFitSummary& found, std::size_t i,
                         double std_error, double most) {
  const FreeParameter& p = set.parameters[i];
  if (found.at_bound[i] != 0) return name_words(p.name) + " ran to the end of its range";
  if (std_error <= most) return {};
  const std::string known = name_words(p.name) + " is known " + error_words(p, std_error);
  const auto at = static_cast<Index>(i);
  const Index partner = alike(found.likeness, at);
  if (partner < 0 || !(std::abs(found.likeness(at, partner)) > kAlike)) {
    return "the motion does not show it: " + known;
  }
  return "the motion does not separate " + name_words(p.name) + " from " +
         name_words(set.parameters[static_cast<std::size_t>(partner)].name) +
         fmt::format(" (their effects are alike to {:.4f}): ",
                     std::abs(found.likeness(at, partner))) +
         known;
}

std::string part_words(const ParameterSet& set, const WindowFitSummary& found, double length_s) {
  std::string text = fmt::format("its last {:.3g} s alone:", length_s);
  for (std::size_t i = 0; i < set.tracked; ++i) {
    const auto at = static_cast<Index>(i);
    text += (i == 0 ? " " : ", ") + name_words(set.parameters[i].name) + " " +
            value_words(set.parameters[i], found.theta[at], found.std_error[at]);
  }
  return text;
}

std::string change_words(const ParameterSet& set, const ParameterChange& named,
                         const Eigen::VectorXd& baseline) {
  const FreeParameter& p = set.parameters[named.parameter];
  const double before = p.to_physical(baseline[static_cast<Index>(named.parameter)]);
  const double now = p.to_physical(named.theta);
  const std::string direction = now > before ? " high" : " low";
  const std::string size =
      is_logarithmic(p) ? fmt::format("{:+.1f} %, ", 100.0 * (now / before - 1.0)) : std::string();
  return name_words(p.name) + direction + ", " + size +
         value_words(p, named.theta, named.std_error);
}

std::string drift_words(const FreeParameter& p, double learnt, double theta) {
  const std::string far =
      is_logarithmic(p)
          ? fmt::format("{:+.1f} %", 100.0 * (p.to_physical(theta) / p.to_physical(learnt) - 1.0))
          : fmt::format("{:+.2g} times its typical size", theta - learnt);
  return name_words(p.name) + " came by and by to " +
         config::units::words(config::units::quantity(p.name, p.to_physical(theta), NAN)) + ", " +
         far + " from what was learnt; slow changes are followed no further";
}

std::string group_words(const ParameterSet& set, const ParameterChange& named) {
  if (named.rivals.empty()) return {};
  std::string text = "or";
  for (std::size_t i = 0; i < named.rivals.size(); ++i) {
    const Rival& rival = named.rivals[i];
    text += (i == 0 ? " " : " or ") + name_words(rival.name) + " " +
            config::units::words(config::units::quantity(rival.name, rival.value, NAN));
  }
  return text +
         (named.sensed.chambers ? ": command, position and chamber pressures cannot tell; "
                                : ": command and position cannot tell; ") +
         advice_words(set, named);
}

std::string advice_words(const ParameterSet& set, const ParameterChange& named) {
  if (named.rivals.empty()) return {};
  std::string all = set.parameters[named.parameter].name;
  for (const Rival& rival : named.rivals) all += " " + rival.name;
  const auto has = [&](const char* word) { return all.find(word) != std::string::npos; };
  const bool sensor = has("position_sensor");
  const bool supply = has("supply") && !named.sensed.supply;
  if (supply && sensor) {
    return "readings of the supply pressure and of a second position sensor would";
  }
  if (supply) return "a reading of the supply pressure would";
  if (sensor) return "a second position sensor would";
  if (!named.sensed.chambers && (has("leakage") || has("air") || has("bulk"))) {
    return "a reading of the chamber pressures would";
  }
  if (has("friction") || has("damping") || has("mass") || has("load")) {
    return "a motion of other speeds and accelerations would";
  }
  return "another motion may";
}

}  // namespace estimator::greybox::tracking
