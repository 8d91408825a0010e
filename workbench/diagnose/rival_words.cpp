#include "workbench/diagnose/rival_words.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/schema/joined.h"
#include "config/units/quantity.h"

namespace workbench::diagnose {
namespace {

/// A pressure on both sides of a piston with two areas is a force: "" where that is not what was
/// found, or the pressure is fitted.
std::string return_pressure_words(const selection::Diagnosis& d) {
  plant_sim::ModelFile model = d.better;
  const double* const cap_m2 = model.value("cap_area_m2");
  const double* const rod_m2 = model.value("rod_side_area_m2");
  const double* const force_N = model.value("load_force.force_N");
  const double* const return_Pa = model.value("return_pressure_Pa");
  const std::vector<std::string> sure = d.established();
  if (cap_m2 == nullptr || rod_m2 == nullptr || force_N == nullptr || return_Pa == nullptr ||
      std::find(sure.begin(), sure.end(), "load_force") == sure.end() ||
      std::any_of(d.parameters.begin(), d.parameters.end(),
                  [](const auto& p) { return p.name == "return_pressure_Pa"; })) {
    return "";
  }
  const double more_Pa = -*force_N / (*cap_m2 - *rod_m2);
  if (!(*return_Pa + more_Pa > 0.0)) return "";
  return "return_pressure_Pa, which is held, acts as load_force does: at " +
         config::units::words(
             config::units::quantity("return_pressure_Pa", *return_Pa + more_Pa, std::nan(""))) +
         " it would be the same force; a gauge would tell.";
}

}  // namespace

std::string groups_words(const selection::Diagnosis& d) {
  const auto text = [](const auto& group) { return config::schema::listed(group, "or"); };
  return config::schema::joined_by(d.ambiguous, text, "; ");
}

std::vector<std::string> rival_words(const selection::Diagnosis& d) {
  std::vector<std::string> out;
  if (d.verdict != selection::Verdict::undetermined && !d.ambiguous.empty()) {
    out.push_back("This motion cannot tell apart: " + groups_words(d) + ".");
  }
  for (const auto& group : d.same_here) {
    if (!d.rests_on_one_of(group)) continue;
    out.push_back("On this plant no motion that was tried tells " + config::schema::listed(group) +
                  " apart: the name is a choice.");
  }
  if (std::string words = return_pressure_words(d); !words.empty()) {
    out.push_back(std::move(words));
  }
  for (const std::string& name : d.established()) {
    if (name != "drive_lag" && name != "transport_delay") continue;
    out.push_back("A lag of the position sensor, such as its filter's, acts as " + name +
                  " does: a second sensor would tell.");
  }
  return out;
}

}  // namespace workbench::diagnose
