// The files that the steps of a study make: models, records that were imported, reports. A step
// that fails leaves none.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "config/record/record.h"
#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "workbench/add/added_effect.h"
#include "workbench/compare/comparison_report.h"
#include "workbench/present/printed_axis.h"
#include "workbench/serve/study.h"
#include "workbench/serve/study_commands.h"

namespace workbench::serve {
namespace {

using config::schema::UsageError;

/// A file made on the way to a change: removed where the change fails.
class MadeFile {
 public:
  explicit MadeFile(std::string path) : path_(std::move(path)) {}
  ~MadeFile() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove(path_, ignored);
  }
  MadeFile(const MadeFile&) = delete;
  MadeFile& operator=(const MadeFile&) = delete;

  void keep() { path_.clear(); }

 private:
  std::string path_;
};

/// True for "t=Time [s],..."; --map alone may name a file instead, which no page may.
bool is_map_text(std::string_view map) {
  const std::size_t key = map.find('=');
  return key != std::string_view::npos && key > 0 &&
         std::all_of(map.begin(), map.begin() + static_cast<std::ptrdiff_t>(key), [](char c) {
           return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0;
         });
}

}  // namespace

std::string Study::import_record(const std::string& record, const std::string& map) {
  if (!is_map_text(map)) {
    throw UsageError("--map: is no pair; allowed: t=COLUMN[s],u=COLUMN[V],y=COLUMN[mm]");
  }
  config::record::ReadOptions reading;
  reading.map = map;
  const config::record::Record read =
      config::record::read_record(folder_.existing(record), reading);
  const std::string file = folder_.fresh_name(stem(record) + "-imported.csv");
  MadeFile made(folder_.path_of(file));
  config::record::write_csv(read, folder_.path_of(file));
  open_record(file, command_of({"spoolwatch", "import", record, "--map", map, "-o", file}));
  made.keep();
  return file;
}

void Study::open_shipped(const std::string& name) {
  for (const ShippedModel& shipped : shipped_models()) {
    if (shipped.name != name) continue;
    const std::string file = folder_.fresh_name(name);
    config::record::write_whole(folder_.path_of(file), shipped.text);
    MadeFile made(folder_.path_of(file));
    Open next = open_;
    next.model = file;
    next.trial.clear();
    next.lineage.remember("# " + file + ": the model " + name + " as it comes with spoolwatch");
    show(std::move(next));
    return made.keep();
  }
  throw UsageError("no model of that name comes with the program");
}

void Study::make_model(const std::string& kind_name, const model::Answers& answers) {
  const model::Kind& kind = model::find_kind(kind_name);
  model::check_answers(kind, answers);
  const std::string file = folder_.fresh_name(kind.name + ".toml");
  std::vector<std::string> words{"spoolwatch", "new", kind.name, "-o", file};
  for (const auto& [flag, value] : answers) {
    words.insert(words.end(), {"--" + flag, add::number_text(value)});
  }
  const std::string command = command_of(words);
  config::record::write_whole(folder_.path_of(file),
                              model::model_text(kind, answers, stem(file), command));
  MadeFile made(folder_.path_of(file));
  Open next = open_;
  next.model = file;
  next.trial.clear();
  next.lineage.add(file, "", "from data sheets");
  next.lineage.remember(command);
  show(std::move(next));
  made.keep();
}

void Study::add_effect(const std::string& effect) {
  if (open_.model.empty()) throw UsageError("no model is open");
  const std::string from = folder_.existing(open_.model);
  std::vector<std::string> values;
  const add::AddedEffect neutral = add::add_effect(from, effect, {});
  for (const plant_sim::ParameterInfo& info : neutral.effect.parameters) {
    if (info.refinement > 0) continue;
    values.push_back(std::string(info.name) + "=" + add::number_text(info.typical));
  }
  const plant_sim::ModelFile with = add::add_effect(from, effect, values).model;
  const std::string file = folder_.fresh_name(derived_name(open_.model, "+" + effect));
  std::vector<std::string> words{"spoolwatch", "add", open_.model, effect};
  words.insert(words.end(), values.begin(), values.end());
  words.insert(words.end(), {"-o", file});
  config::record::write_whole(folder_.path_of(file), plant_sim::print_model(with));
  MadeFile made(folder_.path_of(file));
  take_trial(file, open_.model, "+ " + effect + ", of typical size", command_of(words));
  made.keep();
}

std::string Study::write_report() {
  const present::PrintedAxis axis(motion());
  std::string file = folder_.fresh_name(stem(shown_model()) + ".html");
  std::vector<std::string> words{"spoolwatch", "compare", shown_model(), open_.record};
  add_ignored(words, open_.ignored);
  words.insert(words.end(), {"--report", file});
  const std::string command = command_of(words);
  Open next = open_;
  next.lineage.remember(command);
  MadeFile made(folder_.path_of(file));
  present::write_report(compare::make_report(front().comparison, command), folder_.path_of(file));
  save_session(folder_, next);
  open_ = std::move(next);
  made.keep();
  return file;
}

}  // namespace workbench::serve
