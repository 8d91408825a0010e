// answers.json: what each record of a plan hides.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/truth/case.h"
#include "tests/truth/model_files.h"
#include "tests/truth/plan.h"

namespace truth {
namespace {

std::string list(const std::vector<std::string>& names) {
  std::string text = "[";
  for (const std::string& name : names) {
    text += (text.size() > 1 ? ", \"" : "\"") + name + "\"";
  }
  return text + "]";
}

std::string quoted_or_null(const std::string& text) {
  return text.empty() ? "null" : "\"" + text + "\"";
}

std::string effect(const Planned& planned, std::size_t which) {
  const std::string& name = planned.hidden[which];
  // A servo stands for a cylinder, whose speeds follow areas and pressures only nearly.
  const double least = planned.of.kind == Kind::single_rod ? 0.1 : 0.0;
  std::ostringstream values;
  std::ostringstream scored;
  values.precision(10);
  for (const Parameter& parameter : parameters()) {
    if (parameter.effect != name) continue;
    const double value = value_of(parameter, planned.of);
    if (!std::isfinite(value)) continue;  // an infinite value is none, and JSON has no word for it
    values << (values.tellp() > 0 ? ", " : "") << '"' << parameter.name << "\": " << value;
    if (parameter.tolerance > 0.0) {
      scored << (scored.tellp() > 0 ? ", " : "") << '"' << parameter.name
             << "\": " << std::max(least, parameter.tolerance);
    }
  }
  std::ostringstream text;
  text << "{\"effect\": \"" << name << "\", \"parameters\": {" << values.str() << "}, \"scored\": {"
       << scored.str() << "}, \"visibility_ratio\": " << planned.visibility[which] << "}";
  return text.str();
}

std::string left_out(const Planned& planned) {
  const LeftOutInfo* info = find_left_out(planned.of.left_out.kind);
  if (info == nullptr) return "null";
  std::ostringstream text;
  text << "{\"name\": \"" << info->name << "\", \"equation\": \"" << info->equation
       << "\", \"size\": " << planned.of.left_out.size
       << ", \"where\": " << planned.of.left_out.where << ", \"classes\": " << list(info->classes)
       << ", \"variables\": " << list(info->variables)
       << ", \"same_signal\": " << list(info->same_signal)
       << ", \"visibility_ratio\": " << planned.visibility.back() << "}";
  return text.str();
}

std::string outside(const Outside& of) {
  if (!of.any()) return "null";
  std::ostringstream text;
  text << "{\"force_N\": " << of.force_N << ", \"corner_Hz\": " << of.corner_Hz
       << ", \"pulsation_Pa\": " << of.pulsation_Pa << ", \"pulsation_Hz\": " << of.pulsation_Hz
       << ", \"shake_m\": " << of.shake_m << ", \"shake_Hz\": " << of.shake_Hz
       << ", \"line_N\": " << of.line_N << ", \"line_Hz\": " << of.line_Hz << "}";
  return text.str();
}

}  // namespace

void write_answers(const std::string& file, const std::string& plan, std::size_t seed,
                   const std::vector<Planned>& planned, const std::vector<double>& floors_m) {
  std::ofstream out(file);
  out << "{\"schema_version\": 1, \"plan\": \"" << plan << "\", \"seed\": " << seed
      << ", \"records\": [";
  for (std::size_t i = 0; i < planned.size(); ++i) {
    const Planned& one = planned[i];
    std::string hidden;
    for (std::size_t which = 0; which < one.hidden.size(); ++which) {
      hidden += (which > 0 ? ", " : "") + effect(one, which);
    }
    out << (i > 0 ? ",\n" : "\n") << " {\"file\": \"" << file_name(i) << "\", \"motion\": \""
        << one.of.motion << "\", \"rig\": \"" << to_string(one.of.kind)
        << "\", \"model\": " << quoted_or_null(model_name(one.of.kind))
        << ", \"condition\": " << quoted_or_null(one.condition)
        << ", \"mismatched\": " << (one.of.mismatched ? "true" : "false")
        << ", \"floor_m\": " << floors_m[i]
        << ", \"within_limits\": " << (one.within_limits ? "true" : "false") << ",\n  \"hidden\": ["
        << hidden << "],\n  \"unshown\": " << list(unshown_effects(one.of))
        << ", \"outside\": " << outside(one.of.outside) << ",\n  \"left_out\": " << left_out(one)
        << ",\n  \"seed\": " << one.of.seed << ", \"spec\": \"" << one.text << "\"}";
  }
  out << "\n]}\n";
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

}  // namespace truth
