#include "workbench/diagnose/rival_words.h"

#include <algorithm>

#include "config/schema/joined.h"
#include "plant_sim/model_file.h"

namespace workbench::diagnose {
namespace {

constexpr double kCritical_ratio = 0.25;  ///< inertia of a lag with a double pole

/// True for a second_order_lag with real poles, its error aside.
bool is_overdamped(const selection::Diagnosis& d) {
  return std::any_of(d.parameters.begin(), d.parameters.end(), [](const auto& p) {
    return p.name == "second_order_lag.inertia_ratio" && !(p.value - p.std_error > kCritical_ratio);
  });
}

/// True where a return pressure that no fit moves presses on two areas that differ.
bool holds_return_pressure(const selection::Diagnosis& d) {
  plant_sim::ModelFile model = d.better;
  const double* const cap_m2 = model.value("cap_area_m2");
  const double* const rod_m2 = model.value("rod_side_area_m2");
  return cap_m2 != nullptr && rod_m2 != nullptr && *cap_m2 > *rod_m2 &&
         std::none_of(d.parameters.begin(), d.parameters.end(),
                      [](const auto& p) { return p.name == "return_pressure_Pa"; });
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
    // the first line of the verdict says it
    if (d.verdict == selection::Verdict::missing || !d.rests_on_one_of(group)) continue;
    const std::vector<std::string> others(group.begin() + 1, group.end());
    out.push_back("The name " + group.front() + " is a choice: no motion that was tried tells it " +
                  "from " + config::schema::listed(others, "or") + " on this plant.");
  }
  for (const std::string& name : d.established()) {
    if (name == "load_force" && holds_return_pressure(d)) {
      out.emplace_back(
          "A return pressure other than the file's, which is held, acts much as load_force does: a "
          "gauge would tell.");
    }
    if (name == "second_order_lag" && is_overdamped(d)) {
      out.emplace_back(
          "A damping ratio of 1 or more is that of two lags in a row, of which one may be the "
          "position sensor's filter: a second sensor would tell.");
    }
    if (name != "drive_lag" && name != "transport_delay") continue;
    out.push_back("A lag of the position sensor, such as its filter's, acts as " + name +
                  " does: a second sensor would tell.");
  }
  return out;
}

}  // namespace workbench::diagnose
