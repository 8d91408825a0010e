#include "workbench/model/kinds.h"

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "config/schema/spelling.h"
#include "workbench/model/kind_tables.h"
#include "workbench/model/model_writer.h"

namespace workbench::model {

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = [] {
    std::vector<Kind> list;
    for (const std::vector<Kind>& some : {cylinder_kinds(), motor_kinds(), servo_kinds()})
      list.insert(list.end(), some.begin(), some.end());
    return list;
  }();
  return all;
}

const Kind& find_kind(const std::string& name) {
  std::vector<std::string> names;
  for (const Kind& kind : kinds()) {
    if (kind.name == name) return kind;
    names.push_back(kind.name);
  }
  const std::string near = config::schema::nearest(name, names);
  throw config::schema::UsageError("new: kind " + name + " is unknown" +
                                   (near.empty() ? "" : ", did you mean " + near + "?") +
                                   "; allowed: " + config::schema::joined(names) + ", and stand");
}

Answers with_usual(const Kind& kind, const Answers& answers) {
  Answers all = answers;
  for (const Question& q : kind.questions) all.emplace(q.flag, q.usual);
  return all;
}

std::string model_text(const Kind& kind, const Answers& answers, const std::string& name,
                       const std::string& command) {
  ModelWriter w(name);
  w.comment(kind.name + ": " + kind.what + ". Made by:");
  w.comment("  " + command);
  kind.write(with_usual(kind, answers), w);
  return w.text();
}

}  // namespace workbench::model
