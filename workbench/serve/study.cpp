#include "workbench/serve/study.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "config/signals/nan.h"
#include "estimator/greybox/fit_dataset.h"
#include "estimator/greybox/parameter_catalogue.h"
#include "workbench/add/added_effect.h"
#include "workbench/compare/comparison_report.h"
#include "workbench/present/plot_data.h"
#include "workbench/present/printed_axis.h"
#include "workbench/present/record_section.h"
#include "workbench/present/script_json.h"
#include "workbench/present/shell_command.h"

namespace workbench::serve {
namespace {

using config::schema::UsageError;
using nlohmann::ordered_json;

constexpr const char* kSession = "session.json";
constexpr const char* kScript = "commands.sh";
constexpr std::size_t kMostIgnored = 100;
/// Split of the record that a fit scores itself on.
constexpr const char* kSplit = "blocks";

std::string stem(const std::string& file) { return std::filesystem::path(file).stem().string(); }

std::string command_of(const std::vector<std::string>& words) {
  return present::shell_command(words);
}

void add_ignored(std::vector<std::string>& words, const std::vector<std::string>& spans) {
  for (const std::string& span : spans) {
    words.emplace_back("--ignore");
    words.push_back(span);
  }
}

/// Error on the samples that `--fit blocks` leaves out.
double heldout_of(const validation::Comparison& comparison) {
  const greybox::FitDataset data =
      greybox::fit_dataset({comparison.record}, {}, greybox::parse_split(kSplit));
  const Eigen::Map<const Eigen::VectorXd> error_m(
      comparison.error_m.data(), static_cast<Eigen::Index>(comparison.error_m.size()));
  return greybox::rms(error_m, data.validation_mask);
}

}  // namespace

Study::Study(const SessionFolder& folder) : folder_(folder) {
  std::ifstream in(folder_.path_of(kSession));
  const ordered_json session = ordered_json::parse(in, nullptr, false);
  if (!session.is_object()) return;
  lineage_ = lineage_of(session);
  const auto text = [&](const char* key) {
    const auto found = session.find(key);
    return found != session.end() && found->is_string() ? found->get<std::string>() : "";
  };
  std::vector<std::string> ignored;
  if (const auto spans = session.find("ignored"); spans != session.end() && spans->is_array()) {
    for (const ordered_json& span : *spans) {
      if (span.is_string()) ignored.push_back(span.get<std::string>());
    }
  }
  try {
    show(text("record"), text("model"), text("trial"), ignored);
  } catch (const config::schema::Error&) {
    // Files were renamed or changed meanwhile: the session begins without them.
  }
}

compare::CompareRequest Study::request_of(const std::string& model) const {
  compare::CompareRequest request;
  request.model = folder_.existing(model);
  request.record = folder_.existing(record_);
  request.ignored = ignored_;
  return request;
}

std::optional<Study::Shown> Study::shown_of(const std::string& record, const std::string& model,
                                            const std::vector<std::string>& ignored) const {
  if (record.empty() || model.empty()) return std::nullopt;
  compare::CompareRequest request;
  request.model = folder_.existing(model);
  request.record = folder_.existing(record);
  request.ignored = ignored;
  Shown shown;
  shown.prepared = compare::prepare(request);
  const present::PrintedAxis axis(present::motion_of(shown.prepared.model));
  shown.comparison = validation::compare(shown.prepared.model, shown.prepared.record);
  shown.heldout_m = heldout_of(shown.comparison);
  return shown;
}

void Study::note_errors(const std::string& model, const std::optional<Shown>& shown) {
  if (model.empty()) return;
  ModelNode& node = lineage_.add(model, "", "as it is");
  if (!shown) return;
  node.record = record_;
  node.rotary = shown->prepared.model.rotary();
  node.heldout_m = shown->heldout_m;
  node.rms_m = shown->comparison.rms_m;
  node.noise_floor_m = shown->comparison.noise_floor_m;
}

void Study::show(std::string record, std::string model, std::string trial,
                 std::vector<std::string> ignored) {
  using config::units::Motion;
  const auto motion_in = [&](const std::string& file) {
    return file.empty() ? Motion::linear
                        : present::motion_of(plant_sim::load_model(folder_.existing(file)));
  };
  const Motion live = motion_in(model);
  const Motion motion = trial.empty() ? live : motion_in(trial);
  if (!record.empty()) (void)folder_.existing(record);
  std::optional<Shown> accepted = shown_of(record, model, ignored);
  std::optional<Shown> tried = shown_of(record, trial, ignored);
  record_ = std::move(record);
  model_ = std::move(model);
  trial_ = std::move(trial);
  ignored_ = std::move(ignored);
  motion_ = motion;
  live_rotary_ = live == Motion::rotary;
  accepted_ = std::move(accepted);
  tried_ = std::move(tried);
  note_errors(model_, accepted_);
  note_errors(trial_, tried_);
  save();
}

void Study::open_record(const std::string& record) {
  // Read even where no model is open, so that a mistake is told at once.
  (void)greybox::dataset_of(config::record::read_record(folder_.existing(record)));
  show(record, model_, trial_, {});
}

void Study::open_model(const std::string& model) {
  (void)folder_.existing(model);
  show(record_, model, "", ignored_);
}

void Study::open_shipped(const std::string& name) {
  for (const ShippedModel& shipped : shipped_models()) {
    if (shipped.name != name) continue;
    const std::string file = folder_.fresh_name(name);
    config::record::write_whole(folder_.path_of(file), shipped.text);
    return open_model(file);
  }
  throw UsageError("no model of that name comes with the program");
}

void Study::ignore(const std::vector<std::string>& spans) {
  (void)front();
  if (spans.size() > kMostIgnored) throw UsageError("too many spans are left out");
  for (const std::string& span : spans) {
    if (span.find('@') != std::string::npos) throw UsageError("a span is from:to, in s");
  }
  show(record_, model_, trial_, spans);
}

void Study::add_effect(const std::string& effect) {
  if (model_.empty()) throw UsageError("no model is open");
  const std::string from = folder_.existing(model_);
  std::vector<std::string> values;
  const add::AddedEffect neutral = add::add_effect(from, effect, {});
  for (const plant_sim::ParameterInfo& info : neutral.effect.parameters) {
    if (info.refinement > 0) continue;
    values.push_back(std::string(info.name) + "=" + add::number_text(info.typical));
  }
  const plant_sim::ModelFile with = add::add_effect(from, effect, values).model;
  const std::string file = folder_.fresh_name(stem(model_) + "+" + effect + ".toml");
  std::vector<std::string> words{"spoolwatch", "add", model_, effect};
  words.insert(words.end(), values.begin(), values.end());
  words.insert(words.end(), {"-o", file});
  config::record::write_whole(folder_.path_of(file), plant_sim::print_model(with));
  take_trial(file, model_, "+ " + effect + ", of typical size", command_of(words));
}

void Study::take_trial(const std::string& model, const std::string& parent, const std::string& what,
                       const std::string& command) {
  lineage_.add(model, parent, what);
  lineage_.remember(command);
  show(record_, model_.empty() ? parent : model_, model, ignored_);
}

void Study::accept() {
  if (trial_.empty()) throw UsageError("there is no trial to accept");
  show(record_, trial_, "", ignored_);
}

void Study::undo() {
  if (!trial_.empty()) return show(record_, model_, "", ignored_);
  const ModelNode* const node = lineage_.find(model_);
  if (node == nullptr || node->parent.empty()) throw UsageError("there is nothing to undo");
  show(record_, node->parent, "", ignored_);
}

const Study::Shown& Study::front() const {
  const std::optional<Shown>& shown = tried_ ? tried_ : accepted_;
  if (!shown) throw UsageError("open a record and a model first");
  return *shown;
}

std::string Study::write_report() {
  const std::string model = tried_ ? trial_ : model_;
  const Shown& shown = front();
  const present::PrintedAxis axis(motion_);
  std::string file = folder_.fresh_name(stem(model) + ".html");
  std::vector<std::string> words{"spoolwatch", "compare", model, record_};
  add_ignored(words, ignored_);
  words.insert(words.end(), {"--report", file});
  const std::string command = command_of(words);
  present::write_report(compare::make_report(shown.comparison, command), folder_.path_of(file));
  lineage_.remember(command);
  save();
  return file;
}

std::vector<std::string> Study::assignments_of(const ParameterValues& values) const {
  const plant_sim::ModelFile& model = front().prepared.model;
  std::vector<std::string> assignments;
  for (const auto& [name, value] : values) {
    const auto known = greybox::parameter_catalogue(model);
    const auto info =
        std::find_if(known.begin(), known.end(),
                     [&, &wanted = name](const auto& one) { return one.name == wanted; });
    if (info == known.end()) throw UsageError("a parameter has no such name");
    if (!(value >= info->info.min && value <= info->info.max)) {
      throw UsageError(name + ": is out of range; allowed: " + add::number_text(info->info.min) +
                       " to " + add::number_text(info->info.max));
    }
    assignments.push_back((info->effect.empty() ? "parameters." : "effects.") + name + "=" +
                          add::number_text(value));
  }
  return assignments;
}

fit::FitRequest Study::fit_request(const ParameterValues& values) const {
  (void)front();
  const std::string model = tried_ ? trial_ : model_;
  fit::FitRequest request;
  request.model = folder_.existing(model);
  request.records = {folder_.existing(record_)};
  request.fit = kSplit;
  request.ignored = ignored_;
  request.profiles = {"none"};
  request.assignments = assignments_of(values);
  const std::string file = folder_.fresh_name(stem(model) + "-fitted.toml");
  request.output = folder_.path_of(file);
  std::vector<std::string> words{"spoolwatch", "fit",       model,  record_, "--fit",
                                 kSplit,       "--profile", "none", "-o",    file};
  add_ignored(words, ignored_);
  for (const std::string& assignment : request.assignments) {
    words.insert(words.end(), {"--set", assignment});
  }
  request.command = command_of(words);
  return request;
}

diagnose::DiagnosisRequest Study::diagnosis_request(const std::vector<std::string>& only) const {
  (void)front();
  const std::string model = tried_ ? trial_ : model_;
  diagnose::DiagnosisRequest request;
  request.model = folder_.existing(model);
  request.records = {folder_.existing(record_)};
  request.ignored = ignored_;
  request.only = only;
  std::string suffix = only.empty() ? "-diagnosed" : "";
  for (const std::string& effect : only) suffix.append("+").append(effect);
  const std::string file = folder_.fresh_name(stem(model) + suffix + ".toml");
  request.output = folder_.path_of(file);
  std::vector<std::string> words{"spoolwatch", "diagnose", model, record_};
  for (const std::string& effect : only) words.insert(words.end(), {"--only", effect});
  add_ignored(words, ignored_);
  words.insert(words.end(), {"-o", file});
  request.command = command_of(words);
  return request;
}

void Study::save() const {
  ordered_json session{
      {"record", record_}, {"model", model_}, {"trial", trial_}, {"ignored", ignored_}};
  session.update(to_json(lineage_));
  config::record::write_whole(
      folder_.path_of(kSession),
      session.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n");
  config::record::write_whole(folder_.path_of(kScript), script_of(lineage_));
}

std::string Study::curves(const View& view) const {
  const present::PrintedAxis axis(motion_);
  return columns(nullptr, view);
}

std::string Study::preview(const ParameterValues& values, const View& view) const {
  const Shown& shown = front();
  const present::PrintedAxis axis(motion_);
  compare::CompareRequest request = request_of(tried_ ? trial_ : model_);
  request.assignments = assignments_of(values);
  const plant_sim::ModelFile model = plant_sim::load_model(request.model, request.assignments);
  const validation::ModelErrors errors = validation::errors_of(model, shown.prepared.record);
  std::string json = columns(&errors, view);
  std::vector<std::string> words{"spoolwatch", "compare", tried_ ? trial_ : model_, record_};
  add_ignored(words, ignored_);
  for (const std::string& assignment : request.assignments) {
    words.insert(words.end(), {"--set", assignment});
  }
  json.back() = ',';
  return json + "\"command\":" + present::json_string(command_of(words)) + "}";
}

}  // namespace workbench::serve
