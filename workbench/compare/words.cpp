#include "config/units/quantity.h"
#include "workbench/compare/comparison_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/greybox/motion_scale.h"
#include "workbench/present/compare_units.h"
#include "workbench/present/dataset_notes.h"
#include "workbench/present/disturbance_words.h"
#include "workbench/present/dynamics_plots.h"
#include "workbench/present/record_findings.h"

namespace workbench::compare {

namespace greybox = estimator::greybox;
namespace units = config::units;
namespace {

/// A p value under this is not chance.
constexpr double kSignificant = 1e-3;
/// Least share of the motion that a model explains which follows it, and how far its size may be
/// off.
constexpr double kFollows = 0.8;
constexpr double kOfTheSize = 0.5;
/// Speed errors under this part of the rod's RMS speed are no drift worth a word.
constexpr double kSlightDrift = 0.01;

std::string fails_where(const validation::SignificantRegion& failing) {
  return present::where(failing) + ": " +
         present::percent(failing.figures.local_velocity_error_share) +
         " of the squared speed error arises there, in " +
         present::percent(failing.figures.time_share) + " of the time.";
}

/// The part of the record in which nearly all of the position error lies, in words; empty: there is
/// none. An error that has grown stands still, so that the speed error does not show it.
std::string part_of_record(const validation::Comparison& c) {
  constexpr double kNearlyAll = 0.9;
  constexpr double kPart = 0.5;
  for (const validation::Region& region : c.regions) {
    if (region.variable != "time") continue;
    for (std::size_t i = 0; i < region.bins.size(); ++i) {
      const validation::Bin& bin = region.bins[i];
      if (bin.error_share < kNearlyAll || bin.time_share > kPart) continue;
      validation::SignificantRegion part;
      part.ranges = {
          {region.variable, bin.from, bin.to, bin.name, i == 0, i + 1 == region.bins.size()}};
      return present::where(part) + ": " + present::percent(bin.error_share) +
             " of the squared position error lies there, in " + present::percent(bin.time_share) +
             " of the time.";
    }
  }
  return "";
}

/// A motion against the model's: a turned sign, unless the command drives the motion.
std::string other_way(double gain_ratio, const greybox::CommandResponse& response) {
  const std::string text = "the " + units::moving_part() + " moves the other way than the model, " +
                           units::three_digits(-100.0 * (1.0 + gain_ratio)) + " % as far (";
  if (response.against_command()) {
    return text + "the sign of the command or of the position is turned)";
  }
  if (response.with_command()) {
    return text +
           "the command drives the motion, so no sign is turned: the model lacks something large, "
           "such as a spring)";
  }
  return text + "the model lacks something large, such as a spring, or a sign is turned)";
}

std::string in_proportion(double gain_ratio, const greybox::CommandResponse& response) {
  if (gain_ratio < -1.0) return other_way(gain_ratio, response);
  return "the " + units::moving_part() + " moves " +
         units::three_digits(100.0 * std::abs(gain_ratio)) + " % " +
         (gain_ratio < 0.0 ? "less" : "more") + " than the model";
}

std::string by_a_constant(double offset_mps) {
  return "drifts " + units::speed_words(std::abs(offset_mps)) +
         (units::motion() == units::Motion::rotary ? offset_mps < 0.0 ? " backwards" : " forwards"
          : offset_mps < 0.0                       ? " towards retraction"
                                                   : " towards extension");
}

std::string plain_words(const validation::Comparison& c) {
  const validation::SystematicError& explained = c.systematic;
  std::string text;
  switch (explained.cause) {
    case validation::ErrorCause::gain:
      text = "Off in proportion: " + in_proportion(explained.gain_ratio, c.response);
      break;
    case validation::ErrorCause::offset:
      text = "Off by a constant speed: the " + units::moving_part() + " " +
             by_a_constant(explained.offset_mps);
      break;
    case validation::ErrorCause::both:
      text = "Off in proportion and by a constant speed: " +
             in_proportion(explained.gain_ratio, c.response) + " and " +
             by_a_constant(explained.offset_mps);
      break;
    case validation::ErrorCause::neither:
      return {};
  }
  return text + "; this alone would explain " + present::percent(explained.share) +
         " of the squared error.";
}

/// The rest beyond the plain part.
std::string beyond_words(const validation::Comparison& c) {
  const double left_m = c.systematic.left_rms_m;
  if (left_m <= validation::kAtFloor * c.noise_floor_m)
    return "Beyond that it is at the noise floor.";
  const std::string left = "Beyond that " + units::length_words(left_m) + " are left";
  if (!c.headline.significant) return left + ", with no range standing out.";
  return left + "; it fails " + fails_where(c.headline);
}

std::string size_words(const validation::Comparison& c) {
  std::string text = "Error " + units::length_words(c.rms_m) + " RMS, drift-corrected";
  if (std::isfinite(c.noise_floor_m)) {
    text += ": " + units::three_digits(c.floor_ratio()) + " times the noise floor of " +
            units::length_words(c.noise_floor_m);
  } else {
    text += "; the noise floor cannot be determined from this record";
  }
  return text + ". Free run: " + units::length_words(c.free_run_rms_m) + " RMS, fit " +
         units::three_digits(c.fit_percent) + " %.";
}

const validation::Bin* direction(const validation::Comparison& c, const char* name) {
  for (const validation::Region& region : c.regions) {
    for (const validation::Bin& bin : region.bins) {
      if (bin.name == name) return &bin;
    }
  }
  return nullptr;
}

/// Direction in which the free run drifts; empty where it does not.
std::string drift_words(const validation::Comparison& c) {
  if (c.free_run_rms_m < 2.0 * c.rms_m) return {};
  double squares = 0.0;
  for (const double v : c.kinematics.speed_mps) squares += v * v;
  const double least_mps =
      kSlightDrift * std::sqrt(squares / static_cast<double>(c.kinematics.speed_mps.size()));
  std::string text;
  for (const bool out : {true, false}) {
    const char* const name = out ? "extending" : "retracting";
    const validation::Bin* const bin = direction(c, name);
    if (bin == nullptr || std::abs(bin->speed_error_mps) < least_mps) continue;
    const bool slower = (bin->speed_error_mps < 0.0) == out;
    const bool text_is_new = text.empty();
    text += (text_is_new ? "" : ", ") + units::speed_words(std::abs(bin->speed_error_mps)) +
            (slower ? " slower" : " faster") + (text_is_new ? " than the model" : "") + " while " +
            units::axis_words(name);
  }
  if (text.empty()) return {};
  const double end_m = c.free_error_m.back();
  return "Drifts in the free run, " + units::length_words(std::abs(end_m)) + " at the end: the " +
         units::moving_part() + " runs " + text + ".";
}

std::string dependence_words(const validation::Comparison& c, const DisturbanceCheck& check) {
  if (c.independence_p < kSignificant) {
    return "The residual depends on earlier commands: parameters are off or dynamics are missing.";
  }
  if (c.whiteness_p < kSignificant && check.asked) {
    return "The residual is not white, and independent of the command, yet no disturbance of the "
           "rig accounts for it: `diagnose` seeks what does.";
  }
  if (c.whiteness_p < kSignificant) {
    return "The residual is not white, yet independent of the command: look at what acts without "
           "it, such as the sensor, the load or the supply; `diagnose` measures it.";
  }
  if (!std::isfinite(c.independence_p) || !std::isfinite(c.whiteness_p)) return {};
  return "The residual is white and independent of the command, as noise is.";
}

/// Says which disturbance would leave as much; the command may still show in what is left.
void add_disturbance(const validation::Comparison& c,
                     const estimator::greybox::selection::RemainingDisturbance& found, Words& w) {
  const std::string floor = units::length_words(found.floor_m);
  const bool at_floor = c.rms_m <= validation::kAtFloor * found.floor_m;
  if (at_floor) w.judgement = Judgement::at_floor;
  w.verdict = at_floor ? "At the floor that sensor and disturbance would set, " + floor + "."
                       : "Above the noise floor, and above the " + floor +
                             " that sensor and disturbance would leave.";
  w.lines.push_back(
      c.independence_p < kSignificant
          ? "The residual goes with earlier commands: a controller that answers the disturbance "
            "makes it do so, and so do parameters that are slightly off."
          : "The residual follows neither command nor motion.");
  w.lines.push_back("A disturbance of the rig would explain it: " +
                    present::disturbance_words(found.disturbance) +
                    "; `diagnose` weighs it against the effects of the library.");
}

/// True where the model follows the motion, at its size: no unit or column is mistaken.
bool follows(const validation::Comparison& c) {
  return c.floor_ratio() <= validation::kAtFloor ||
         (c.motion.explained > kFollows && std::abs(c.motion.ratio - 1.0) < kOfTheSize);
}

/// A size that a unit may account for; empty where the model follows the record.
std::string size_finding_of(const validation::Comparison& c) {
  if (follows(c)) return {};
  return present::size_finding(estimator::greybox::usual_range(c.record.y_m), c.stroke_m, c.motion,
                               c.record.command_column, c.record.position_column);
}

/// True for a position that moves against the command and lies within the stroke only when turned.
bool is_turned(const validation::Comparison& c) {
  const auto [low_m, high_m] = estimator::greybox::usual_range(c.record.y_m);
  return c.response.against_command() && estimator::greybox::lies_turned(low_m, high_m, c.stroke_m);
}

/// True for a record of which a note asks whether it was read rightly: what the error looks like
/// then says nothing of the model. A sign that is turned within the stroke has words of its own.
bool may_be_misread(const validation::Comparison& c) {
  return (c.response.columns_exchanged() && !follows(c)) || c.response.delay_s < 0.0 ||
         is_turned(c) || !size_finding_of(c).empty();
}

}  // namespace

Words words(const validation::Comparison& c, const DisturbanceCheck& check) {
  Words w;
  const auto add = [&](const std::string& line) {
    if (!line.empty()) w.lines.push_back(line);
  };
  if (!std::isfinite(c.rms_m) || !std::isfinite(c.free_run_rms_m)) {
    w.judgement = Judgement::useless;
    w.verdict = "The model's position leaves all bounds: nothing can be compared.";
    return w;
  }
  if (c.floor_ratio() <= validation::kAtFloor) {
    w.judgement = Judgement::at_floor;
    w.verdict = "At the noise floor: nothing left to explain.";
    add(size_words(c));
    add(drift_words(c));
    if (c.independence_p < kSignificant) {
      add("A trace of the command is left in the residual, too small to show in its size.");
    }
    return w;
  }
  if (may_be_misread(c)) {
    w.judgement = Judgement::fails_throughout;
    w.verdict = "Probably misread: correct the reading as the note says, then compare again.";
    add(size_words(c));
    return w;
  }
  if (check.found) {
    add_disturbance(c, *check.found, w);
    add(size_words(c));
    add(drift_words(c));
    return w;
  }
  const bool somewhere = c.headline.significant;
  const std::string part = c.independence_p < kSignificant ? part_of_record(c) : "";
  const std::string plain = plain_words(c);
  if (!plain.empty()) {
    w.judgement = Judgement::fails_throughout;
    w.verdict = plain;
    add(beyond_words(c));
  } else if (somewhere) {
    w.judgement = Judgement::fails_somewhere;
    w.verdict = "Fails " + fails_where(c.headline);
  } else if (!part.empty()) {
    w.judgement = Judgement::fails_somewhere;
    w.verdict = "Fails " + part;
  } else if (c.independence_p >= kSignificant && !check.asked) {
    w.verdict =
        "Above the noise floor, yet nothing that is left follows the command, position, velocity "
        "or "
        "time: like a disturbance.";
  } else {
    w.verdict = "Fails throughout: no range of position, velocity, command or time stands out.";
  }
  add(size_words(c));
  add(drift_words(c));
  if (c.resonance) add(present::resonance_words(*c.resonance));
  add(dependence_words(c, check));
  return w;
}

std::vector<std::string> notes(const validation::Comparison& c) {
  using Limitation = validation::CommandRange::Limitation;
  std::vector<std::string> out = present::notes_of(c.record);
  const double percent = 100.0 * c.command.limited_share;
  switch (c.command.limitation) {
    case Limitation::none:
      break;
    case Limitation::constant:
      out.push_back(fmt::format(
          "the command stays at {:.4g} V: the model is tried at this one value", c.command.most_V));
      break;
    case Limitation::always_limited:
      out.push_back(
          fmt::format("the command is at +-{:.4g} V in {:.0f} % of the samples: smaller "
                      "commands are hardly tried",
                      c.command.most_V, percent));
      break;
    case Limitation::often_limited:
      out.push_back(
          fmt::format("the command is at its limit of +-{:.4g} V in {:.0f} % of the samples",
                      c.command.most_V, percent));
      break;
  }
  if (is_turned(c)) {
    out.push_back(present::turned_position_finding(c.record.position_column));
    return out;
  }
  const std::string size = size_finding_of(c);
  if (!size.empty()) out.push_back(size);
  for (std::string& text :
       present::response_findings(c.response, c.record.command_column, c.record.position_column)) {
    out.push_back(std::move(text));
  }
  if (c.beyond_stroke && size.empty()) {
    out.push_back(
        fmt::format("y runs from {:.4g} to {:.4g} mm, outside the model's stroke of 0 to {:.4g} mm",
                    1e3 * c.beyond_stroke->low_m, 1e3 * c.beyond_stroke->high_m,
                    1e3 * c.beyond_stroke->stroke_m));
  }
  return out;
}

}  // namespace workbench::compare
