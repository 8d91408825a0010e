// A study is what a session has open: a record, a model, perhaps a trial model beside it, and how
// they compare. One object for all pages, used by one thread; it computes nothing of its own but
// calls what the commands call.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "config/units/quantity.h"
#include "estimator/greybox/validation/comparison.h"
#include "workbench/compare/request.h"
#include "workbench/diagnose/request.h"
#include "workbench/fit/request.h"
#include "workbench/model/kinds.h"
#include "workbench/serve/kept_models.h"
#include "workbench/serve/lineage.h"
#include "workbench/serve/session_file.h"
#include "workbench/serve/session_folder.h"

namespace workbench::serve {

namespace greybox = estimator::greybox;
namespace validation = estimator::greybox::validation;

/// Part of the record that a page shows, and how finely.
struct View {
  double from_s = 0.0;
  double to_s = 0.0;  ///< not above from_s: the whole record
  std::size_t rows = 3000;
};

/// Values of parameters by the names of model files, as sliders set them.
using ParameterValues = std::map<std::string, double>;

class Study {
 public:
  /// Continues the session of the folder, where there is one; says on standard error and in state()
  /// why it does not. Throws config::schema::RunError where it would overwrite one.
  explicit Study(const SessionFolder& folder);

  // Each throws config::schema::Error, or another std::exception for want of memory; the session
  // and what is open are then as before, and files that it made are removed.

  /// `command`: the line that made the file; empty: none did.
  void open_record(const std::string& record, const std::string& command = "");
  /// Makes the record that a file is with the mapping `map`, as `spoolwatch import` does, and opens
  /// it; its name.
  std::string import_record(const std::string& record, const std::string& map);
  void open_model(const std::string& model);
  /// Copies a shipped model into the folder and opens it.
  void open_shipped(const std::string& name);
  /// Makes a model file from the numbers of data sheets and opens it; what is left open has its
  /// usual value.
  void make_model(const std::string& kind, const model::Answers& answers);
  /// "from:to" in s: samples that neither count nor are fitted.
  void ignore(const std::vector<std::string>& spans);
  /// The model with an effect of typical size, as a trial.
  void add_effect(const std::string& effect);
  void accept();
  /// Another model beside the one that is shown; empty: none. It stays until another is opened.
  void put_beside(const std::string& model);
  /// Gives up the trial; without one, back to the model that this one came from.
  void undo();
  /// Writes the report of `compare` beside the record; its file name.
  std::string write_report();

  /// Requests of the running commands for what is open, with a fresh output file.
  [[nodiscard]] fit::FitRequest fit_request(const ParameterValues& values) const;
  /// A diagnosis begins from the model `from`; empty: the one that is shown.
  [[nodiscard]] diagnose::DiagnosisRequest diagnosis_request(const std::vector<std::string>& only,
                                                             const std::string& from = "") const;
  /// A model that a command has made from `parent` becomes the trial. Throws as the above; the
  /// model's file stays.
  void take_trial(const std::string& model, const std::string& parent, const std::string& what,
                  const std::string& command);

  /// After the folder was lost: writes the session again, and its models that are gone. Throws
  /// config::schema::RunError.
  void restore();

  /// The model that is open, for the live page; empty: none.
  [[nodiscard]] const std::string& live_model() const { return open_.model; }

  /// Everything that a page shows besides the curves.
  [[nodiscard]] nlohmann::ordered_json state();
  /// Curves of what is open: JSON text.
  [[nodiscard]] std::string curves(const View& view) const;
  /// The laws of what is shown beside the record's samples, and those of the model before a trial:
  /// JSON text.
  [[nodiscard]] std::string laws() const;
  /// Model and error with other values, at the rows of curves() for the same view.
  [[nodiscard]] std::string preview(const ParameterValues& values, const View& view) const;

 private:
  /// The session, what is beside it without being saved, and what follows from its files alone.
  struct Open : SavedSession {
    std::string beside;
    std::optional<plant_sim::ModelFile> shown;  ///< the trial, or else the model
  };
  struct Shown {
    compare::PreparedComparison prepared;
    validation::Comparison comparison;
    double heldout_m = 0.0;
  };
  [[nodiscard]] compare::CompareRequest request_of(const std::string& model) const;
  [[nodiscard]] std::vector<std::string> assignments_of(const ParameterValues& values) const;
  [[nodiscard]] std::optional<Shown> shown_of(const std::string& record, const std::string& model,
                                              const std::vector<std::string>& ignored) const;
  /// Compares and saves `next`, then takes it.
  void show(Open next, bool saves = true);
  /// As accepted: `model` without a trial.
  void show_model(const std::string& model);
  static void note_errors(Open& next, const std::string& model, const std::optional<Shown>& shown);
  /// Motion of the axis that is shown.
  [[nodiscard]] config::units::Motion motion() const;
  /// The trial, or else the model.
  [[nodiscard]] const std::string& shown_model() const;
  [[nodiscard]] const Shown& front() const;
  /// Drawn beside it: what was put there, or the model before the trial; null: none.
  [[nodiscard]] const Shown* ghost() const;
  [[nodiscard]] nlohmann::ordered_json side_by_side() const;
  /// `changed`: the curves of a model with other values, alone; null: everything.
  [[nodiscard]] std::string columns(const validation::ModelErrors* changed, const View& view) const;

  const SessionFolder& folder_;
  std::string notice_;  ///< why the session is not the saved one; empty: it is
  Open open_;
  KeptModels kept_;
  std::optional<Shown> accepted_, tried_, beside_;
};

}  // namespace workbench::serve
