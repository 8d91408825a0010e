// Summary of a fit as sentences.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "estimator/greybox/held_scale.h"
#include "workbench/fit/fit_report.h"

namespace workbench::fit {
namespace {

using config::units::length_words;

constexpr double kAtFloor = 1.15;
/// Moves of fewer standard errors are not reported.
constexpr double kNews = 2.0;
constexpr std::size_t kMostMoved = 4;

std::string move_words(const greybox::EstimatedParameter& p) {
  const config::units::Quantity q = config::units::quantity(p.free.name, p.value, p.std_error);
  std::string text = p.free.name;
  if (p.start > 0.0 && p.value > 0.0 && std::isfinite(p.start) && std::isfinite(p.value)) {
    text += fmt::format(" {:+.2g} % to ", 100.0 * (p.value / p.start - 1.0)) + words(q);
  } else {
    text += " from " + words(config::units::quantity(p.free.name, p.start, std::nan(""), p.value)) +
            " to " + words(q);
  }
  return text;
}

double errors_moved(const greybox::EstimatedParameter& p) {
  const double moved = std::abs(p.value - p.start);
  if (!(moved > 0.0)) return 0.0;
  return std::isfinite(p.std_error) && p.std_error > 0.0 ? moved / p.std_error : 1e6;
}

std::string size_words(const FitReport& o) {
  const greybox::EstimationSummary& e = o.estimation;
  std::string text = "Error " + length_words(e.before.rms_m) + " -> " +
                     length_words(e.after.rms_m) + " RMS" +
                     (o.prepared->options.observer_per_s > 0.0 ? ", drift-corrected" : "");
  if (std::isfinite(o.noise_floor_m)) {
    const double ratio = e.after.rms_m / o.noise_floor_m;
    text += "; noise floor " + length_words(o.noise_floor_m);
    text += ratio <= kAtFloor ? ": the model now explains all but the noise"
                              : fmt::format(": still {:.3g} times as much", ratio);
  } else {
    text += "; the noise floor cannot be determined from this record";
  }
  return text + ". Free run: " + length_words(e.before.free_run_rms_m) + " -> " +
         length_words(e.after.free_run_rms_m) +
         fmt::format(" RMS, fit {:.4g}", e.before.fit_percent) +
         fmt::format(" -> {:.4g} %.", e.after.fit_percent);
}

std::string heldout_words(const greybox::EstimationSummary& e) {
  if (!std::isfinite(e.after.heldout_rms_m)) return "";
  std::string text = "On data that were not fitted: " + length_words(e.before.heldout_rms_m) +
                     " -> " + length_words(e.after.heldout_rms_m) + " RMS.";
  if (e.after.heldout_rms_m > e.before.heldout_rms_m) {
    text += " The fit does not hold there: it is no better than the model as it was.";
  }
  return text;
}

std::string moved_words(const greybox::EstimationSummary& e) {
  std::vector<const greybox::EstimatedParameter*> moved;
  for (const greybox::EstimatedParameter& p : e.parameters) {
    if (errors_moved(p) > kNews) moved.push_back(&p);
  }
  if (moved.empty()) return "No parameter moved by more than chance.";
  std::stable_sort(moved.begin(), moved.end(), [](const auto* a, const auto* b) {
    return errors_moved(*a) > errors_moved(*b);
  });
  std::string text = "Moved: ";
  for (std::size_t i = 0; i < std::min(moved.size(), kMostMoved); ++i) {
    text += (i == 0 ? "" : ", ") + move_words(*moved[i]);
  }
  if (moved.size() > kMostMoved) {
    text += ", and " + std::to_string(moved.size() - kMostMoved) + " more";
  }
  return text + ".";
}

std::string bound_words(const greybox::EstimationSummary& e) {
  std::string text;
  for (const greybox::EstimatedParameter& p : e.parameters) {
    if (p.at_bound == 0) continue;
    text += (text.empty() ? "" : ", ") + p.free.name +
            (p.at_bound < 0 ? " at its lower" : " at its upper") + " bound";
  }
  return text.empty() ? text : "At a limit: " + text + ".";
}

std::string starts_words(const greybox::MultistartCounts& s) {
  if (s.tried < 2) return "";
  std::string text =
      std::to_string(s.same) + " of " + std::to_string(s.tried) + " starts ended in this minimum";
  if (s.elsewhere > 0) text += ", " + std::to_string(s.elsewhere) + " as good at other values";
  if (s.worse > 0) text += ", " + std::to_string(s.worse) + " in a worse one";
  return text + ".";
}

std::string sight_words(const greybox::IdentifiabilityReport& report,
                        const std::vector<greybox::EstimatedParameter>& parameters) {
  const auto words = [&parameters](const greybox::UnidentifiableParameter& unseen) {
    return unidentifiable_words(unseen, parameters);
  };
  const std::string text = config::schema::joined_by(report.unidentifiable, words, "; ");
  return text.empty() ? "" : text + ".";
}

std::string power_of(const std::string& name, double exponent) {
  if (std::abs(exponent - 1.0) < 0.1) return name;
  if (std::abs(exponent - 0.5) < 0.05) return "sqrt(" + name + ")";
  return fmt::format("{}^{:.2g}", name, exponent);
}

/// Product that stays constant when b follows a with d ln b / d ln a = slope.
std::string product(const std::string& b, const std::string& a, double slope) {
  return slope < 0.0 ? b + " * " + power_of(a, -slope) : b + " / " + power_of(a, slope);
}

}  // namespace

std::string remark(const greybox::EstimatedParameter& p) {
  if (p.at_bound < 0) return "at its lower bound";
  if (p.at_bound > 0) return "at its upper bound";
  if (std::isinf(p.std_error)) return "not visible";
  if (std::isfinite(p.free.prior_sd) && p.record_share < 0.51) return "held by its prior";
  const std::string doubt = to_string(p.doubt);
  if (p.from_profile) return doubt.empty() ? "profile" : "profile: " + doubt;
  return doubt;
}

std::string to_string(greybox::IntervalDoubt doubt) {
  using greybox::IntervalDoubt;
  switch (doubt) {
    case IntervalDoubt::none:
      break;
    case IntervalDoubt::at_bound:
      return "at its bound";
    case IntervalDoubt::not_visible:
      return "not visible";
    case IntervalDoubt::large_std_error:
      return "large standard error";
    case IntervalDoubt::not_quadratic:
      return "the likelihood is not quadratic";
  }
  return {};
}

std::string progress_words(const greybox::EstimationProgress& progress) {
  using Step = greybox::EstimationProgress::Step;
  switch (progress.step) {
    case Step::identifiability:
      return "checking which parameters the record determines";
    case Step::multistart:
      return "fitting from " + std::to_string(progress.starts) +
             (progress.starts == 1 ? " start" : " starts");
    case Step::descent:
      return "fitting";
    case Step::restart:
      return "a profile found a lower cost: fitting again from there";
    case Step::profile:
      return "profile of " + config::schema::joined(progress.parameters);
  }
  return {};
}

std::string visible_words(const greybox::UnidentifiableParameter& unseen,
                          const std::vector<greybox::EstimatedParameter>& parameters) {
  std::vector<std::string> products;
  for (const greybox::VisibleProduct& one : unseen.visible) {
    products.push_back(product(parameters[one.partner].free.name,
                               parameters[unseen.parameter].free.name, one.slope));
  }
  return config::schema::listed(products);
}

std::string unidentifiable_words(const greybox::UnidentifiableParameter& unseen,
                                 const std::vector<greybox::EstimatedParameter>& parameters) {
  using Cause = greybox::UnidentifiableParameter::Cause;
  const std::string& name = parameters[unseen.parameter].free.name;
  const std::string visible = visible_words(unseen, parameters);
  std::vector<std::string> partners;
  for (const std::size_t i : unseen.partners) partners.push_back(parameters[i].free.name);
  std::string text;
  if (unseen.cause == Cause::no_influence) {
    text = "the record hardly depends on " + name;
  } else if (!visible.empty()) {
    text = "only " + visible + (partners.size() == 1 ? " is visible" : " are visible");
  } else if (unseen.cause == Cause::one_partner) {
    text = name + " and " + partners.front() + " cannot be told apart";
  } else {
    text = name + " can be traded against " +
           (partners.empty() ? "the others together" : config::schema::listed(partners));
  }
  return text + ": " +
         (unseen.has_prior ? "its prior holds " + name
                           : name + " has no prior and stays arbitrary");
}

std::vector<std::string> fitted_names(const greybox::EstimationSummary& estimation) {
  std::vector<std::string> names;
  for (const greybox::EstimatedParameter& p : estimation.parameters) names.push_back(p.free.name);
  return names;
}

std::vector<std::string> record_names(const FitReport& o) {
  std::vector<std::string> names;
  for (const greybox::Dataset& record : o.prepared->problem.data.records) {
    if (std::find(names.begin(), names.end(), record.name) == names.end()) {
      names.push_back(record.name);
    }
  }
  return names;
}

std::vector<std::string> words(const FitReport& o) {
  const greybox::EstimationSummary& e = o.estimation;
  std::vector<std::string> said{size_words(o), heldout_words(e), moved_words(e), bound_words(e)};
  const std::string before = sight_words(e.identifiability_before, e.parameters);
  const std::string after = sight_words(e.identifiability_after, e.parameters);
  if (before == after && !before.empty()) {
    said.push_back("Parameters that the record does not determine, before the fit and after it: " +
                   before);
  } else {
    if (!before.empty())
      said.push_back("Parameters that the record does not determine, at the start: " + before);
    if (!after.empty())
      said.push_back("Parameters that the record does not determine, after the fit: " + after);
    if (after.empty()) said.push_back("The record determines every fitted parameter.");
  }
  said.push_back(greybox::held_scale_words(e.better, fitted_names(e)));
  said.push_back(starts_words(e.starts));
  if (e.interrupted) said.insert(said.begin(), "Interrupted: this is the best so far.");
  for (const std::string& note : o.prepared->notes) said.push_back("Note: " + note + ".");
  said.erase(std::remove(said.begin(), said.end(), std::string()), said.end());
  return said;
}

std::string to_model(const FitReport& o) {
  const greybox::EstimationSummary& e = o.estimation;
  std::string text = "# Fitted by: " + o.prepared->command + "\n";
  for (const auto& record : o.prepared->problem.data.records)
    text += "# record " + record.name + "\n";
  text += "# error " + config::units::length_words(e.before.rms_m) + " -> " +
          config::units::length_words(e.after.rms_m) + " RMS" +
          (e.interrupted ? "; interrupted, the best so far" : "") + "\n";
  for (const greybox::EstimatedParameter& p : e.parameters) {
    const std::string more = remark(p);
    text += fmt::format("# {} {:.6g}, 95 % from {:.6g} to {:.6g}{}{}\n", p.free.name, p.value,
                        p.low, p.high, more.empty() ? "" : "; ", more);
  }
  return text + plant_sim::print_model(e.better);
}

}  // namespace workbench::fit
