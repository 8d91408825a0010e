#include "workbench/diagnose/place_words.h"

#include <fmt/format.h>

#include "workbench/diagnose/advice_words.h"

namespace workbench::diagnose {
namespace {

/// "as a force that goes with the speed". `plant`: its name; without a valve nothing flows.
std::string where_words(const selection::Localisation& where, const std::string& plant) {
  const std::string enters = where.site == "flow"
                                 ? has_site(plant, "opening") ? "as a flow" : "as a speed"
                             : where.site == "force" ? "as a force"
                             : where.site == "gain"  ? "as a change of the gain"
                                                     : "as an error of the measurement";
  const std::string variable = where.variable == "y"   ? "the position y"
                               : where.variable == "v" ? "the velocity v"
                               : where.variable == "u" ? "the command u"
                                                       : "the " + where.variable;
  return enters + " that goes with " + variable;
}

std::string percent(const selection::Localisation& where) {
  return fmt::format("{:.0f} %", 100.0 * where.explained_ratio);
}

/// The error that is placed: the remainder, or the whole where changes or effects were taken.
std::string error_words(const selection::Diagnosis& d) {
  if (!d.where_is_whole || (d.missing.empty() && d.changing.empty())) return "The remaining error";
  if (d.missing.empty()) return "The error of the model without change";
  return d.missing.size() > 1 ? "The error without these effects" : "The error without this effect";
}

}  // namespace

std::string place_words(const selection::Diagnosis& d) {
  const std::string& plant = d.better.plant;
  std::string text = error_words(d) + " enters " + where_words(d.where[0], plant) + " (" +
                     percent(d.where[0]) + " of its square)";
  if (d.where.size() > 1) {
    text += ", or " + where_words(d.where[1], plant) + " (" + percent(d.where[1]) + ")";
  }
  return text + ".";
}

}  // namespace workbench::diagnose
