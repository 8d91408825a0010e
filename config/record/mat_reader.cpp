#include "config/record/readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "config/record/assembly.h"
#include "config/record/column_roles.h"
#include "config/record/layout.h"
#include "config/record/mat_variables.h"
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

/// The MATLAB line that saves the numbers of timeseries; the times are those of the first.
std::string series_script(const std::vector<std::string>& names) {
  std::string script = "t = " + names.front() + ".Time; ";
  std::string saved;
  for (const std::string& name : names) {
    const std::string field = name.substr(name.rfind('.') + 1);
    script += fmt::format("{} = squeeze({}.Data); ", field, name);
    saved += fmt::format(", \"{}\"", field);
  }
  return script + "save(\"vectors.mat\", \"t\"" + saved + ")";
}

/// The same of timetables, each of which becomes a CSV file.
std::string table_script(const std::vector<std::string>& names) {
  const auto one = [](const std::string& name) {
    const std::string times = name + ".Properties.RowTimes";
    return name + ".t_s = seconds(" + times + " - " + times + "(1)); writetable(timetable2table(" +
           name + ", \"ConvertRowTimes\", false), \"" + name + ".csv\")";
  };
  return schema::joined_by(names, one, "; ");
}

/// The variables that are objects of MATLAB's classes, and how to save what is in them; empty
/// without any.
std::string object_words(const MatVariables& variables) {
  std::vector<std::string> names;
  std::vector<std::string> classes;
  for (const MatVariable& variable : variables) {
    if (variable.object_class.empty()) continue;
    const std::string of_class = printable(variable.object_class);
    if (std::find(classes.begin(), classes.end(), of_class) == classes.end()) {
      classes.push_back(of_class);
    }
    names.push_back(printable(variable.name));
  }
  if (names.empty()) return "";
  const std::string words =
      schema::listed(names) + (names.size() == 1 ? " is an object" : " are objects") + " (" +
      schema::joined(classes) + "), whose layout in a file MATLAB does not document; ";
  const bool one_class = classes.size() == 1;
  if (one_class && classes[0] == "timeseries") return words + "in MATLAB: " + series_script(names);
  if (one_class && classes[0] == "timetable") return words + "in MATLAB: " + table_script(names);
  return words +
         "in MATLAB save vectors: of a timeseries ts, ts.Time and ts.Data; of a timetable tt, "
         "seconds(tt.Properties.RowTimes) and each tt.NAME; of a Dataset ds, those of each "
         "timeseries ds{k}.Values";
}

/// Why it cannot be a column; empty when it can.
std::string objection(const MatVariable& variable) {
  if (!variable.numeric) return "is of type " + variable.type;
  if (variable.complex) return "is complex";
  if (!variable.values.empty()) return "";
  return "is " + schema::joined(variable.dims, " x ");
}

/// Every vector of the file under its own name, with its structure's where that is not enough:
/// "time", "rig.command", "valve.command".
void flatten(const MatVariables& variables, const std::string& path, MatVariables& flat) {
  for (const MatVariable& variable : variables) {
    const std::string name = path.empty() ? variable.name : path + "." + variable.name;
    if (!variable.fields.empty()) {
      flatten(variable.fields, name, flat);
    } else {
      MatVariable named = variable;
      named.name = name;
      flat.push_back(std::move(named));
    }
  }
}

MatVariables flattened(const MatVariables& variables) {
  MatVariables flat;
  flatten(variables, "", flat);
  const auto last = [](const std::string& name) { return name.substr(name.rfind('.') + 1); };
  std::map<std::string, int> uses;
  for (const MatVariable& variable : flat) ++uses[last(variable.name)];
  for (MatVariable& variable : flat) {
    const std::string name = last(variable.name);
    // The column of a matrix has a number for a name.
    const bool number = !name.empty() && name.front() >= '0' && name.front() <= '9';
    if (uses[name] == 1 && !number) variable.name = name;
  }
  return flat;
}

/// The period that a scalar of the usual names states, s; 0: none.
double stated_period_s(const MatVariables& variables) {
  for (const MatVariable& variable : variables) {
    if (!variable.numeric || variable.values.size() != 1) continue;
    const double value = variable.values[0];
    if (!(value > 0.0) || !std::isfinite(value)) continue;
    for (const char* name : {"Ts", "Ts_s", "dt", "dt_s", "sample_time_s"}) {
      if (variable.name == name) return value;
    }
    for (const char* name : {"Fs", "fs", "Fs_Hz", "fs_Hz", "rate_Hz", "sample_rate_Hz"}) {
      if (variable.name == name) return 1.0 / value;
    }
  }
  return 0.0;
}

class MatReader {
 public:
  MatReader(std::vector<MatVariable> variables, const std::string& name, const ReadOptions& options)
      : name_(name), options_(options), variables_(std::move(variables)) {}

  Record read() {
    const std::vector<MapEntry> map = parse_map(options_.map);
    const MatVariables* scope = map.empty() ? &scope_of(variables_, name_) : nullptr;
    MatVariables flat;
    if (scope == nullptr || !has_time(*scope)) {
      flat = flattened(variables_);
      scope = &flat;
    }
    objects_ = object_words(flattened(variables_));
    choose(*scope, map);
    FileHead head;
    head.where = name_;
    head.variables = true;
    head.step_s = stated_period_s(*scope);
    if (chosen_.size() < 3) {
      head.more = !objects_.empty()   ? objects_
                  : left_out_.empty() ? ""
                                      : "and no vectors: " + names_of(left_out_);
    }
    FileValues values;
    values.name = name_;
    for (const MatVariable* variable : chosen_) {
      FileColumn column;
      column.header = printable(variable->name);
      column.unit = variable->unit;
      column.factor = variable->factor;
      const std::size_t shown = std::min<std::size_t>(60, variable->values.size());
      column.sample.assign(variable->values.begin(),
                           variable->values.begin() + static_cast<std::ptrdiff_t>(shown));
      head.columns.push_back(std::move(column));
    }
    const Layout layout = understand(head, map, options_.position_optional);
    require_one_length(layout);
    for (const MatVariable* variable : chosen_) values.values.push_back(variable->values);
    values.place = [this](std::size_t i) { return name_ + ": sample " + std::to_string(i + 1); };
    values.header = [&head](std::size_t i) { return "variable " + head.columns[i].header; };
    Record record = assemble(layout, std::move(values), options_);
    for (ChannelOrigin& origin : record.origins) {
      origin.header = head.columns[origin.column - 1].header;
    }
    if (!objects_.empty()) record.notes.push_back("left out: " + objects_);
    if (!left_out_.empty()) {
      record.notes.push_back("left out, no " + std::string(kVectors) +
                             " of the time's length: " + names_of(left_out_));
    }
    return record;
  }

 private:
  /// The variables that may become columns: vectors of the time's length, or the most frequent one.
  void choose(const MatVariables& scope, const std::vector<MapEntry>& map) {
    const MatVariable* time = nullptr;
    for (const MatVariable& variable : scope) {
      if (time == nullptr && is_time(parse_column(variable.name))) time = &variable;
    }
    if (time != nullptr && !objection(*time).empty() && map.empty()) {
      refuse(*time, objection(*time));
    }
    std::size_t length = time != nullptr && objection(*time).empty() ? time->values.size() : 0;
    if (length == 0) {
      std::map<std::size_t, int> lengths;
      for (const MatVariable& variable : scope) {
        if (objection(variable).empty() && variable.values.size() > 1) {
          ++lengths[variable.values.size()];
        }
      }
      int most = 0;
      for (const auto& [size, count] : lengths) {
        if (count >= most) {
          most = count;
          length = size;
        }
      }
    }
    const bool separate = !map.empty() && !options_.resample.empty();
    for (const MatVariable& variable : scope) {
      std::string why = objection(variable);
      if (why.empty() && length != 0 && variable.values.size() != length && !separate) {
        why = "has " + std::to_string(variable.values.size()) + " values, but " +
              (time != nullptr ? printable(time->name) + " has " + std::to_string(length)
                               : "most have " + std::to_string(length));
      }
      if (why.empty() && variable.values.size() > 1) {
        chosen_.push_back(&variable);
      } else if (is_main(parse_column(variable.name)) && map.empty()) {
        refuse(variable, why.empty() ? objection(variable) : why);
      } else {
        if (!variable.object_class.empty()) continue;
        MatVariable named;
        named.name = variable.name;
        left_out_.push_back(std::move(named));
      }
    }
  }

  /// Channels without times of their own are rows of one table.
  void require_one_length(Layout layout) const {
    if (!options_.resample.empty()) return;
    for (const Channel& channel : layout.channels) {
      const MatVariable& variable = *chosen_[channel.column];
      const MatVariable& first = *chosen_[layout.channels.front().column];
      if (variable.values.size() != first.values.size()) {
        refuse(variable, "has " + std::to_string(variable.values.size()) + " values, but " +
                             printable(first.name) + " has " + std::to_string(first.values.size()));
      }
    }
  }

  [[noreturn]] void refuse(const MatVariable& variable, const std::string& why) const {
    if (!variable.object_class.empty()) throw bad_data(name_, objects_);
    throw bad_data(name_, "variable " + printable(variable.name) + " " + why,
                   std::string(kVectors) + ", all of one length");
  }

  const std::string& name_;
  const ReadOptions& options_;
  const MatVariables variables_;
  std::vector<const MatVariable*> chosen_;
  MatVariables left_out_;  ///< names alone
  std::string objects_;    ///< what is said of MATLAB's objects; empty: there are none
};

}  // namespace

const char* other_mat_format(std::string_view head) noexcept {
  if (head.starts_with("# Created by Octave")) return "is in Octave's text format";
  if (head.starts_with("Octave-1-")) return "is in Octave's binary format";
  if (head.starts_with("MATLAB 5.0")) return "is cut off within the header";
  return nullptr;
}

bool is_hdf5(std::string_view head) noexcept {
  return head.starts_with("MATLAB 7.3") || head.starts_with("\x89HDF\r\n");
}

Record read_variables(std::vector<MatVariable> variables, const std::string& name,
                      const ReadOptions& options, const std::string& form) {
  Record record = MatReader(std::move(variables), name, options).read();
  record.form = form;
  return record;
}

Record read_mat(std::string_view content, const std::string& name, const ReadOptions& options) {
  return read_variables(read_mat_variables(content, name), name, options, "MAT file of version 5");
}

}  // namespace config::record
