#include "estimator/fdi/tracker/tracking_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/units/quantity.h"

namespace estimator::fdi::tracker {
namespace {

using Eigen::Index;
using greybox::ParameterScale;

std::string percent(double ratio) { return fmt::format("{:.3g} %", 100.0 * ratio); }

bool is_logarithmic(const FreeParameter& p) { return p.scale == ParameterScale::logarithmic; }

/// "12 %" of the value, or "0.3 times its typical size".
std::string error_words(const FreeParameter& p, double std_error) {
  if (!std::isfinite(std_error)) return "not at all";
  return is_logarithmic(p) ? "to +- " + percent(std_error) + " only"
                           : fmt::format("to +- {:.2g} of its typical size only", std_error);
}

std::string pressure_words(double value_Pa) {
  return config::units::words(config::units::quantity("pressure_Pa", value_Pa, NAN));
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

std::string disturbance_words(const ProcessNoise& noise, const DisturbanceLevel& level) {
  std::string text = noise.force ? "random force " + config::units::words(config::units::quantity(
                                                         "force_N", level.random, NAN))
                                 : "random speed " + config::units::speed_words(level.random);
  text += fmt::format(" below {:.2g} Hz", noise.model.noise.corner_Hz);
  for (std::size_t i = 0; i < noise.model.lines.size(); ++i) {
    const auto& line = noise.model.lines[i];
    const std::string unit = noise.unit_of(line.site);
    const double value = i < level.line_values.size() ? level.line_values[i] : NAN;
    text += "; " + noise.site_name(line.site) +
            fmt::format(" line at {:.2f} Hz, ", line.frequency_Hz) +
            (unit == "m/s"
                 ? config::units::speed_words(value)
                 : config::units::words(config::units::quantity("amplitude_" + unit, value, NAN)));
  }
  return text;
}

std::string misfit_words(const Misfit& misfit) {
  const std::string chamber = misfit.inlet ? "pressure in" : "pressure out";
  switch (misfit.cause) {
    case Misfit::Cause::none:
      break;
    case Misfit::Cause::position:
      return "the model does not explain it: error " + config::units::length_words(misfit.found) +
             ", healthy " + config::units::length_words(misfit.healthy) +
             fmt::format(", limit {:.3g} times that", misfit.limit);
    case Misfit::Cause::pressure_error:
      return "the model does not explain the " + chamber + ": error " +
             pressure_words(misfit.found) + ", healthy " + pressure_words(misfit.healthy) +
             fmt::format(", limit {:.3g} times that", misfit.limit);
    case Misfit::Cause::pressure_offset:
      return "the " + chamber + " is off the model: by " + pressure_words(misfit.found) +
             " from when it was healthy, limit " + pressure_words(misfit.limit);
  }
  return {};
}

std::string left_out_words(const PressuresLeftOut& left_out) {
  const std::string begin = "chamber pressures left out because ";
  switch (left_out.cause) {
    case PressuresLeftOut::Cause::none:
      break;
    case PressuresLeftOut::Cause::not_read:
      return begin + "they were not read in the whole window";
    case PressuresLeftOut::Cause::inlet_still:
      return begin + "the reading of the pressure in stands still";
    case PressuresLeftOut::Cause::outlet_still:
      return begin + "the reading of the pressure out stands still";
    case PressuresLeftOut::Cause::misfit:
      return begin + misfit_words(left_out.misfit);
  }
  return {};
}

std::string invalid_words(const ParameterSet& set, const InvalidReason& reason) {
  const FreeParameter& p = set.parameters[reason.parameter];
  const std::string known = name_words(p.name) + " is known " + error_words(p, reason.std_error);
  switch (reason.cause) {
    case InvalidReason::Cause::none:
      break;
    case InvalidReason::Cause::no_motion:
      return fmt::format("no motion: within {:.3g} s the rod moves ", reason.window_s) +
             config::units::length_words(reason.motion_m) + ", the position's noise is " +
             config::units::length_words(reason.noise_m);
    case InvalidReason::Cause::misfit:
      return misfit_words(reason.misfit);
    case InvalidReason::Cause::needs_pressures:
      return "position alone does not tell valve gain from supply pressure: " +
             left_out_words(reason.left_out);
    case InvalidReason::Cause::at_bound:
      return name_words(p.name) + " ran to the end of its range";
    case InvalidReason::Cause::not_excited:
      return "the motion does not show it: " + known;
    case InvalidReason::Cause::not_separable:
      return "the motion does not separate " + name_words(p.name) + " from " +
             name_words(set.parameters[reason.partner].name) +
             fmt::format(" (their effects are alike to {:.4f}): ", reason.likeness) + known;
  }
  return {};
}

std::string part_words(const ParameterSet& set, const PartialFit& part) {
  std::string text = fmt::format("its last {:.3g} s alone:", part.length_s);
  for (std::size_t i = 0; i < set.tracked; ++i) {
    const auto at = static_cast<Index>(i);
    text += (i == 0 ? " " : ", ") + name_words(set.parameters[i].name) + " " +
            value_words(set.parameters[i], part.theta[at], part.std_error[at]);
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
  return name_words(p.name) + " has drifted to " +
         config::units::words(config::units::quantity(p.name, p.to_physical(theta), NAN)) + ", " +
         far + " from the learned value; slow changes beyond this are not followed";
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

std::string probe_words(const ExcitationDesign& probe) {
  return "probe with a sine of " + config::units::length_words(probe.amplitude_m) +
         fmt::format(" at {:.3g} Hz about ", probe.frequency_Hz) +
         config::units::length_words(probe.centre_m) +
         fmt::format(" for {:.2g} s", probe.duration_s);
}

}  // namespace estimator::fdi::tracker
