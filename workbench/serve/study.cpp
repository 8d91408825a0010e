#include "workbench/serve/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

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
#include "workbench/serve/slider_unit.h"
#include "workbench/serve/study_commands.h"

namespace workbench::serve {
namespace {

using config::schema::UsageError;

constexpr std::size_t kMostIgnored = 100;
/// Split of the record that a fit scores itself on.
constexpr const char* kSplit = "blocks";

/// Error on the samples that `--fit blocks` leaves out.
double heldout_of(const validation::Comparison& comparison) {
  const greybox::FitDataset data =
      greybox::fit_dataset({comparison.record}, {}, greybox::parse_split(kSplit));
  const Eigen::Map<const Eigen::VectorXd> error_m(
      comparison.error_m.data(), static_cast<Eigen::Index>(comparison.error_m.size()));
  return greybox::rms(error_m, data.validation_mask);
}

/// "0 to 50 mm"
std::string allowed_range(const greybox::CatalogueParameter& parameter, double value) {
  const config::units::PrintedScale scale = slider_unit(parameter, value);
  return config::units::typeset(fmt::format("{:.6g} to {:.6g} {}", parameter.info.min / scale.in_si,
                                            parameter.info.max / scale.in_si, scale.unit));
}

}  // namespace

Study::Study(const SessionFolder& folder) : folder_(folder) {
  LoadedSession loaded = load_session(folder);
  notice_ = std::move(loaded.notice);
  Open next;
  static_cast<SavedSession&>(next) = std::move(loaded.session);
  open_.lineage = next.lineage;
  try {
    show(std::move(next), false);  // a full disk keeps nobody from looking
  } catch (const config::schema::Error& error) {
    // Files were renamed or changed meanwhile.
    notice_ = std::string("the session begins without its record and model: ") + error.what();
  }
  if (!notice_.empty()) std::cerr << "spoolwatch serve: " << notice_ << '\n';
}

compare::CompareRequest Study::request_of(const std::string& model) const {
  compare::CompareRequest request;
  request.model = folder_.existing(model);
  request.record = folder_.existing(open_.record);
  request.ignored = open_.ignored;
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

void Study::note_errors(Open& next, const std::string& model, const std::optional<Shown>& shown) {
  if (model.empty()) return;
  ModelNode& node = next.lineage.add(model, "", "as it is");
  if (!shown) return;
  node.record = next.record;
  node.rotary = shown->prepared.model.rotary();
  node.heldout_m = shown->heldout_m;
  node.rms_m = shown->comparison.rms_m;
  node.noise_floor_m = shown->comparison.noise_floor_m;
}

void Study::show(Open next, bool saves) {
  next.shown.reset();
  if (!next.model.empty()) next.shown = plant_sim::load_model(folder_.existing(next.model));
  if (!next.trial.empty()) next.shown = plant_sim::load_model(folder_.existing(next.trial));
  if (!next.record.empty()) (void)folder_.existing(next.record);
  std::optional<Shown> accepted = shown_of(next.record, next.model, next.ignored);
  std::optional<Shown> tried = shown_of(next.record, next.trial, next.ignored);
  std::optional<Shown> beside;
  if (next.beside == (next.trial.empty() ? next.model : next.trial)) next.beside.clear();
  try {
    beside = shown_of(next.record, next.beside, next.ignored);
  } catch (const config::schema::Error&) {
    if (next.beside != open_.beside) throw;
    next.beside.clear();  // its file has gone, or it cannot be compared with this record
  }
  note_errors(next, next.model, accepted);
  note_errors(next, next.trial, tried);
  if (saves) save_session(folder_, next);
  open_ = std::move(next);
  kept_.keep(folder_, open_.model);
  kept_.keep(folder_, open_.trial);
  accepted_ = std::move(accepted);
  tried_ = std::move(tried);
  beside_ = std::move(beside);
}

void Study::restore() {
  if (!session_is_there(folder_)) kept_.restore(folder_);
  save_session(folder_, open_);
}

void Study::show_model(const std::string& model) {
  Open next = open_;
  next.model = model;
  next.trial.clear();
  show(std::move(next));
}

config::units::Motion Study::motion() const {
  return open_.shown ? present::motion_of(*open_.shown) : config::units::Motion::linear;
}

const std::string& Study::shown_model() const {
  return open_.trial.empty() ? open_.model : open_.trial;
}

void Study::open_record(const std::string& record, const std::string& command) {
  // Read even where no model is open, so that a mistake is told at once.
  (void)greybox::dataset_of(config::record::read_record(folder_.existing(record)));
  Open next = open_;
  next.record = record;
  next.ignored.clear();
  if (!command.empty()) next.lineage.remember(command);
  show(std::move(next));
}

void Study::open_model(const std::string& model) {
  (void)folder_.existing(model);
  show_model(model);
}

void Study::ignore(const std::vector<std::string>& spans) {
  (void)front();
  if (spans.size() > kMostIgnored) throw UsageError("too many spans are left out");
  for (const std::string& span : spans) {
    if (span.find('@') != std::string::npos) throw UsageError("a span is from:to, in s");
  }
  Open next = open_;
  next.ignored = spans;
  show(std::move(next));
}

void Study::take_trial(const std::string& model, const std::string& parent, const std::string& what,
                       const std::string& command) {
  Open next = open_;
  next.lineage.add(model, parent, what);
  next.lineage.remember(command);
  if (next.model.empty()) next.model = parent;
  next.trial = model;
  show(std::move(next));
}

void Study::accept() {
  if (open_.trial.empty()) throw UsageError("there is no trial to accept");
  show_model(open_.trial);
}

void Study::undo() {
  if (!open_.trial.empty()) return show_model(open_.model);
  const ModelNode* const node = open_.lineage.find(open_.model);
  if (node == nullptr || node->parent.empty()) throw UsageError("there is nothing to undo");
  show_model(node->parent);
}

void Study::put_beside(const std::string& model) {
  (void)front();
  if (!model.empty()) (void)folder_.existing(model);
  if (model == shown_model()) throw UsageError("this model is the one that is shown");
  Open next = open_;
  next.beside = model;
  show(std::move(next));
}

const Study::Shown* Study::ghost() const {
  if (beside_) return &*beside_;
  return tried_ && accepted_ ? &*accepted_ : nullptr;
}

const Study::Shown& Study::front() const {
  const std::optional<Shown>& shown = tried_ ? tried_ : accepted_;
  if (!shown) throw UsageError("open a record and a model first");
  return *shown;
}

std::vector<std::string> Study::assignments_of(const ParameterValues& values) const {
  const plant_sim::ModelFile& model = front().prepared.model;
  const present::PrintedAxis axis(motion());
  plant_sim::ModelFile shown = model;
  std::vector<std::string> assignments;
  for (const auto& [name, value] : values) {
    const auto known = greybox::parameter_catalogue(model);
    const auto info =
        std::find_if(known.begin(), known.end(),
                     [&, &wanted = name](const auto& one) { return one.name == wanted; });
    if (info == known.end()) throw UsageError("a parameter has no such name");
    if (!(value >= info->info.min && value <= info->info.max)) {
      const double* const now = shown.value(name);
      throw UsageError(name + ": is out of range; allowed: " +
                       allowed_range(*info, now != nullptr ? *now : 0.0));
    }
    assignments.push_back((info->effect.empty() ? "parameters." : "effects.") + name + "=" +
                          add::number_text(value));
  }
  return assignments;
}

fit::FitRequest Study::fit_request(const ParameterValues& values) const {
  (void)front();
  const std::string& model = shown_model();
  fit::FitRequest request;
  request.model = folder_.existing(model);
  request.records = {folder_.existing(open_.record)};
  request.fit = kSplit;
  request.ignored = open_.ignored;
  request.profiles = {"none"};
  request.assignments = assignments_of(values);
  const std::string file = folder_.fresh_name(derived_name(model, "-fitted"));
  request.output = folder_.path_of(file);
  std::vector<std::string> words{"spoolwatch", "fit",       model,  open_.record, "--fit",
                                 kSplit,       "--profile", "none", "-o",         file};
  add_ignored(words, open_.ignored);
  for (const std::string& assignment : request.assignments) {
    words.insert(words.end(), {"--set", assignment});
  }
  request.command = command_of(words);
  return request;
}

diagnose::DiagnosisRequest Study::diagnosis_request(const std::vector<std::string>& only,
                                                    const std::string& from) const {
  (void)front();
  const std::string& model = from.empty() ? shown_model() : from;
  diagnose::DiagnosisRequest request;
  request.model = folder_.existing(model);
  request.records = {folder_.existing(open_.record)};
  request.ignored = open_.ignored;
  request.only = only;
  std::string suffix = only.empty() ? "-diagnosed" : "";
  for (const std::string& effect : only) suffix.append("+").append(effect);
  const std::string file = folder_.fresh_name(derived_name(model, suffix));
  request.output = folder_.path_of(file);
  std::vector<std::string> words{"spoolwatch", "diagnose", model, open_.record};
  for (const std::string& effect : only) words.insert(words.end(), {"--only", effect});
  add_ignored(words, open_.ignored);
  words.insert(words.end(), {"-o", file});
  request.command = command_of(words);
  return request;
}

std::string Study::curves(const View& view) const {
  const present::PrintedAxis axis(motion());
  return columns(nullptr, view);
}

std::string Study::preview(const ParameterValues& values, const View& view) const {
  const Shown& shown = front();
  const present::PrintedAxis axis(motion());
  compare::CompareRequest request = request_of(shown_model());
  request.assignments = assignments_of(values);
  const plant_sim::ModelFile model = plant_sim::load_model(request.model, request.assignments);
  const validation::ModelErrors errors = validation::errors_of(model, shown.prepared.record);
  std::string json = columns(&errors, view);
  std::vector<std::string> words{"spoolwatch", "compare", shown_model(), open_.record};
  add_ignored(words, open_.ignored);
  for (const std::string& assignment : request.assignments) {
    words.insert(words.end(), {"--set", assignment});
  }
  json.back() = ',';
  return json + "\"command\":" + present::json_string(command_of(words)) + "}";
}

}  // namespace workbench::serve
