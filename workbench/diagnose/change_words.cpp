#include "workbench/diagnose/change_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "estimator/greybox/free_parameter.h"
#include "estimator/greybox/selection/law_dictionary.h"
#include "workbench/diagnose/effect_words.h"

namespace workbench::diagnose {

namespace {

/// To 10 ms, with the error where that is more.
std::string time_words(const selection::ParameterChange& change) {
  if (!(change.at_error_s > 0.005)) return fmt::format("{:.2f} s", change.at_s);
  return config::units::words(config::units::quantity("at_s", change.at_s, change.at_error_s));
}

}  // namespace

std::string change_words(const selection::ParameterChange& change) {
  const auto words = [&](double value, double error) {
    return config::units::words(config::units::quantity(change.parameter, value, error));
  };
  if (change.kind == selection::ChangeKind::record) {
    return change.parameter + " is " + words(change.to, change.to_error) + " in " + change.record +
           " and " + words(change.from, change.from_error) + " elsewhere";
  }
  std::string text = change.parameter + " goes from " + words(change.from, change.from_error) +
                     " to " + words(change.to, change.to_error);
  switch (change.kind) {
    case selection::ChangeKind::step:
      return text + " at " + time_words(change);
    case selection::ChangeKind::ramp:
      return text + fmt::format(" between {:.1f} and {:.1f} s", change.at_s,
                                change.at_s + change.duration_s);
    case selection::ChangeKind::exponential:
    case selection::ChangeKind::record:
      break;
  }
  if (change.is_dated) text += fmt::format(" from {:.1f} s on", change.at_s);
  return text + fmt::format(" with a time constant of {:.1f} s", change.duration_s);
}

std::string step_name(const std::string& added) {
  constexpr std::string_view kChange = "change.";
  std::string name;
  for (std::string_view rest = added; !rest.empty();) {
    constexpr std::string_view kAnd = " + ";
    const std::size_t end = std::min(rest.find(kAnd), rest.size());
    const std::string_view one = rest.substr(0, end);
    rest.remove_prefix(std::min(end + kAnd.size(), rest.size()));
    if (!name.empty()) name += kAnd;
    if (!one.starts_with(kChange)) {
      name += one;
      continue;
    }
    const std::size_t at = one.find(estimator::greybox::kInRecord);
    name += one.substr(kChange.size(), std::min(at, one.size()) - kChange.size());
    name += at < one.size() ? " of " + std::string(one.substr(at + 1)) : " that changes";
  }
  return name;
}

namespace {

std::string beside_changes(const selection::Diagnosis& d) {
  if (d.missing.empty()) return "no effect of the library explains the record, but ";
  const std::vector<std::string> established = d.established();
  if (established.empty()) return names_words(d, d.missing) + " may be missing, and ";
  return names_words(d, established) + (established.size() > 1 ? " are" : " is") + " missing, and ";
}

/// "reading_scale: position sensor whose scale is off." for the changes, and their rivals, of what
/// the library has no effect for.
std::string law_words(const selection::Diagnosis& d) {
  std::string text;
  for (const plant_sim::formula::FormulaEffect& law : d.better.formula_effects) {
    const bool changes = std::any_of(d.changing.begin(), d.changing.end(), [&](const auto& change) {
      return change.parameter.starts_with(law.name + ".");
    });
    if (changes) text += " " + law.name + ": " + law.what + ".";
  }
  const auto is_reading_scale = [](const std::string& parameter) {
    return parameter.starts_with(std::string(selection::kReadingScale) + ".");
  };
  const bool is_rival = std::any_of(d.changing.begin(), d.changing.end(), [&](const auto& change) {
    return std::any_of(change.rivals.begin(), change.rivals.end(), is_reading_scale);
  });
  if (is_rival && text.empty())
    text = std::string(" ") + selection::kReadingScale + ": " + selection::kReadingScaleWords + ".";
  return text;
}

}  // namespace

std::string changing_words(const selection::Diagnosis& d) {
  std::string text = "Changing: " + beside_changes(d) +
                     config::schema::joined_by(d.changing, change_words, "; and ") + ".";
  for (const selection::ParameterChange& change : d.changing) {
    if (change.rivals.empty()) continue;
    text += " A change of " + config::schema::listed(change.rivals, "or") + " in place of " +
            change.parameter + " would explain it about as well.";
  }
  return text + law_words(d);
}

}  // namespace workbench::diagnose
