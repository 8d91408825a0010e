#include "workbench/model/model_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace workbench::model {
namespace {

/// Six digits, always with a point or an exponent.
std::string number(double value) {
  std::string text = fmt::format("{:.6g}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string line(const std::string& key, double value, const std::string& comment) {
  const std::string text = key + " = " + number(value);
  return comment.empty() ? text + "\n" : fmt::format("{:<48} # {}\n", text, comment);
}

}  // namespace

void ModelWriter::comment(const std::string& text) { head_ += "# " + text + "\n"; }

void ModelWriter::begin(const std::string& plant, bool rotary) {
  plant_name_ = plant;
  plant_ = "plant = \"" + plant + "\"\n";
  if (rotary) plant_ += "motion = \"rotary\"\n";
}

void ModelWriter::value(const std::string& key, double value, double prior_ratio,
                        const std::string& comment) {
  values_.emplace_back(key, value);
  parameters_ += line(key, value, comment);
  if (value > 0.0 && !std::isnan(prior_ratio)) priors_ += line(key, prior_ratio, "");
}

void ModelWriter::initial(const std::string& key, double value, const std::string& comment) {
  initial_ += line(key, value, comment);
}

void ModelWriter::effect(const std::string& name,
                         const std::vector<std::pair<std::string, double>>& values,
                         const std::string& comment) {
  effects_ += "\n# " + comment + "\n[effects." + name + "]\n";
  for (const auto& [key, value] : values) effects_ += line(key, value, "");
}

void ModelWriter::start_of_references() {
  initial("y_m", 0.305, "where the references of `simulate` start; there is no end of the stroke");
}

void ModelWriter::loop(double kp_V_per_m) {
  constexpr double kMost_V_per_m = 1e6;  // of a model file
  loop_ = line("kp_V_per_m", std::min(kp_V_per_m, kMost_V_per_m), "");
}

void ModelWriter::axis_loop(double mass_kg, double damping_N_s_per_m, double gain_N_per_V) {
  constexpr double kDamping = 0.7;
  const double rate = 0.5 * damping_N_s_per_m / (kDamping * mass_kg);
  loop(mass_kg * rate * rate / gain_N_per_V);
  if (rate == 0.0) {
    loop_ = line("kp_V_per_m", 0.0, "without damping a loop of kp alone never comes to rest");
  }
}

std::string ModelWriter::text() const {
  std::string out = head_ + "schema_version = 1\nname = \"" + name_ + "\"\n" + plant_ +
                    "step_s = 0.001\n\n[parameters]\n" + parameters_;
  if (!priors_.empty()) {
    out +=
        "\n# Relative standard deviation between rig and data sheet; 0 holds a value in every "
        "fit.\n"
        "[priors]\n" +
        priors_;
  }
  if (!initial_.empty()) out += "\n[initial]\n" + initial_;
  out += effects_;
  if (!loop_.empty()) out += "\n# Controller of `simulate`.\n[loop]\n" + loop_;
  return out;
}

}  // namespace workbench::model
