#include "workbench/diagnose/change_words.h"

#include <fmt/format.h>

#include "config/schema/joined.h"
#include "config/units/quantity.h"

namespace workbench::diagnose {

std::string change_words(const selection::ParameterChange& change) {
  const auto words = [&](double value, double error) {
    return config::units::words(config::units::quantity(change.parameter, value, error));
  };
  if (change.kind == selection::ChangeKind::record) {
    return change.parameter + " is " + words(change.to, change.to_error) + " in " + change.record +
           " and " + words(change.from, change.from_error) + " in the other records";
  }
  std::string text = change.parameter + " goes from " + words(change.from, change.from_error) +
                     " to " + words(change.to, change.to_error);
  switch (change.kind) {
    case selection::ChangeKind::step:
      return text + fmt::format(" at {:.2f} s", change.at_s);
    case selection::ChangeKind::ramp:
      return text + fmt::format(" between {:.1f} and {:.1f} s", change.at_s,
                                change.at_s + change.duration_s);
    case selection::ChangeKind::exponential:
    case selection::ChangeKind::record:
      break;
  }
  return text + fmt::format(" with a time constant of {:.1f} s", change.duration_s);
}

namespace {

std::string beside_changes(const selection::Diagnosis& d) {
  using config::schema::listed;
  if (d.missing.empty()) return "no effect of the library explains the record, but ";
  const std::vector<std::string> established = d.established();
  if (established.empty()) return listed(d.missing) + " may be missing, and ";
  return listed(established) + (established.size() > 1 ? " are" : " is") + " missing, and ";
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
  return text;
}

}  // namespace workbench::diagnose
