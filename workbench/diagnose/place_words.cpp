#include "workbench/diagnose/place_words.h"

#include <fmt/format.h>

#include <vector>

#include "config/schema/joined.h"
#include "workbench/diagnose/advice_words.h"

namespace workbench::diagnose {
namespace {

/// "as a force". `plant`: its name; without a valve nothing flows.
std::string site_words(const std::string& site, const std::string& plant) {
  if (site == "flow") return has_site(plant, "opening") ? "as a flow" : "as a speed";
  if (site == "force") return "as a force";
  if (site == "gain") return "as a change of the gain";
  if (site == "lag") return "as a lag between command and reading";
  return "as an error of the measurement";
}

std::string phrase_of(const std::string& variable) {
  return variable == "y"   ? "the position y"
         : variable == "v" ? "the velocity v"
         : variable == "u" ? "the command u"
                           : "the " + variable;
}

/// "as a force that goes with the speed".
std::string where_words(const selection::Localisation& where, const std::string& plant) {
  return site_words(where.site, plant) + " that goes with " + phrase_of(where.variable);
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

/// The variable alone, and the sites among which the record does not decide. Where a change
/// explains the error, that is the place.
std::string unknown_place_words(const selection::Diagnosis& d) {
  const selection::Localisation& first = d.where[0];
  std::string text = error_words(d) + " goes with " + phrase_of(first.variable) + " (" +
                     percent(first) + " of its square)";
  if (d.where.size() > 1) {
    text += ", or with " + phrase_of(d.where[1].variable) + " (" + percent(d.where[1]) + ")";
  }
  if (d.verdict == selection::Verdict::changing) return text + ".";
  std::vector<std::string> sites{site_words(first.site, d.better.plant)};
  for (const std::string& site : first.or_sites) {
    sites.push_back(site_words(site, d.better.plant));
  }
  return text + "; the record cannot tell whether it enters " +
         config::schema::listed(sites, "or") + ".";
}

}  // namespace

std::string place_words(const selection::Diagnosis& d) {
  if (!d.where[0].or_sites.empty()) return unknown_place_words(d);
  const std::string& plant = d.better.plant;
  std::string text = error_words(d) + " enters " + where_words(d.where[0], plant) + " (" +
                     percent(d.where[0]) + " of its square)";
  if (d.where.size() > 1 && d.where[1].or_sites.empty()) {
    text += ", or " + where_words(d.where[1], plant) + " (" + percent(d.where[1]) + ")";
  }
  return text + ".";
}

}  // namespace workbench::diagnose
