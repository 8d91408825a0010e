#include "config/record/readers.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "config/record/layout.h"
#include "config/record/mat_variables.h"
#include "config/record/time_grid.h"
#include "config/schema/error.h"
#include "config/schema/joined.h"

namespace config::record {
namespace {

using schema::bad_data;
using MatVariables = std::vector<MatVariable>;

constexpr const char* kVectors = "vectors of real numbers";

std::string printable(std::string_view name) {
  const std::string text = quoted(name);
  return text.substr(1, text.size() - 2);
}

/// "t_s, u_V, ..."; at most a dozen.
std::string names_of(const MatVariables& variables) {
  constexpr std::size_t kMost = 12;
  std::string names;
  for (std::size_t i = 0; i < std::min(kMost, variables.size()); ++i) {
    names += (i == 0 ? "" : ", ") + printable(variables[i].name);
  }
  if (variables.size() > kMost) names += ", ...";
  return names.empty() ? "no variables" : names;
}

bool has_time(const MatVariables& variables) {
  return std::any_of(variables.begin(), variables.end(), [](const MatVariable& variable) {
    return is_time(parse_column(variable.name));
  });
}

/// The variables of the file, or the fields of the one structure that has a time.
const MatVariables& scope_of(const MatVariables& variables, const std::string& name) {
  if (has_time(variables)) return variables;
  const MatVariable* found = nullptr;
  for (const MatVariable& variable : variables) {
    if (!has_time(variable.fields)) continue;
    if (found != nullptr) {
      throw bad_data(name,
                     "has several structures with a time, " + printable(found->name) + " and " +
                         printable(variable.name),
                     "one");
    }
    found = &variable;
  }
  return found != nullptr ? found->fields : variables;
}

/// Why it cannot be a column; empty when it can.
std::string objection(const MatVariable& variable) {
  if (!variable.numeric) return "is of type " + variable.type;
  if (variable.complex) return "is complex";
  if (!variable.values.empty()) return "";
  return "is " + config::schema::joined(variable.dims, " x ");
}

class MatReader {
 public:
  MatReader(std::string_view content, const std::string& name)
      : name_(name), variables_(read_mat_variables(content, name)) {
    record_.name = name;
  }

  Record read() {
    const MatVariables& scope = scope_of(variables_, name_);
    choose(scope);
    std::vector<std::string> names;
    for (const MatVariable* variable : chosen_) names.push_back(printable(variable->name));
    const std::vector<Target> targets = lay_out(names, name_, record_);
    if (const MissingColumn* missing = first_missing(targets, record_)) {
      throw bad_data(name_, std::string("lacks a ") + missing->what + " variable",
                     std::string(missing->allowed) + "; it has: " + names_of(scope));
    }
    for (std::size_t i = 0; i < targets.size(); ++i) fill(targets[i], chosen_[i]->values);
    TimeGrid grid = find_grid(
        record_.t_s, [this](std::size_t i) { return name_ + ": sample " + std::to_string(i + 1); });
    record_.sample_time_s = grid.sample_time_s;
    record_.gaps = std::move(grid.gaps);
    if (!left_out_.empty()) {
      record_.notes.push_back("left out, no " + std::string(kVectors) +
                              " of the time's length: " + names_of(left_out_));
    }
    return std::move(record_);
  }

 private:
  /// The variables that become columns: time, command and position must.
  void choose(const MatVariables& scope) {
    const MatVariable* time = nullptr;
    for (const MatVariable& variable : scope) {
      if (time == nullptr && is_time(parse_column(variable.name))) time = &variable;
    }
    if (time != nullptr && !objection(*time).empty()) refuse(*time, objection(*time));
    for (const MatVariable& variable : scope) {
      std::string why = objection(variable);
      if (why.empty() && time != nullptr && variable.values.size() != time->values.size()) {
        why = "has " + std::to_string(variable.values.size()) + " values, but " +
              printable(time->name) + " has " + std::to_string(time->values.size());
      }
      if (why.empty()) {
        chosen_.push_back(&variable);
      } else if (is_main(parse_column(variable.name))) {
        refuse(variable, why);
      } else {
        MatVariable named;
        named.name = variable.name;
        left_out_.push_back(std::move(named));
      }
    }
  }

  [[noreturn]] void refuse(const MatVariable& variable, const std::string& why) const {
    throw bad_data(name_, "variable " + printable(variable.name) + " " + why,
                   std::string(kVectors) + ", all of one length");
  }

  void fill(const Target& target, const std::vector<double>& values) const {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool missing = std::isnan(values[i]) && target.may_be_missing;
      if (!std::isfinite(values[i]) && !missing) {
        throw bad_data(name_,
                       "variable " + target.name + "(" + std::to_string(i + 1) + ") is " +
                           (std::isnan(values[i]) ? "NaN" : "infinite"),
                       "finite numbers");
      }
      const double value = values[i] * target.factor;
      if (std::abs(value) > largest_plausible(target.si_unit)) {
        std::ostringstream shown;
        shown << "variable " << target.name << "(" << i + 1 << ") is " << values[i];
        throw bad_data(name_, shown.str(), plausible_range(target.si_unit));
      }
      target.values->push_back(value);
    }
  }

  const std::string& name_;
  const MatVariables variables_;
  Record record_;
  std::vector<const MatVariable*> chosen_;
  MatVariables left_out_;  ///< names alone
};

}  // namespace

const char* other_mat_format(std::string_view head) noexcept {
  if (head.starts_with("MATLAB 7.3") || head.starts_with("\x89HDF")) {
    return "is a MAT file of version 7.3 (HDF5)";
  }
  if (head.starts_with("# Created by Octave")) return "is in Octave's text format";
  if (head.starts_with("Octave-1-")) return "is in Octave's binary format";
  if (head.starts_with("MATLAB 5.0")) return "is cut off within the header";
  return nullptr;
}

Record read_mat(std::string_view content, const std::string& name) {
  return MatReader(content, name).read();
}

}  // namespace config::record
