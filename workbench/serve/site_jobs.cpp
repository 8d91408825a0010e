// Fits and diagnoses that a page begins, what becomes of their results, and the folder that these
// are written to, which may be full or gone when they end.
#include <chrono>
#include <iostream>
#include <mutex>
#include <utility>

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "workbench/diagnose/words.h"
#include "workbench/serve/request_fields.h"
#include "workbench/serve/site.h"

namespace workbench::serve {
namespace {

using config::schema::UsageError;

constexpr std::chrono::seconds kFolderPeriod{1};

/// Takes the result of a job at the end of a scope, however that ends.
class Taken {
 public:
  explicit Taken(Jobs& jobs) : jobs_(jobs) {}
  ~Taken() { jobs_.taken(); }
  Taken(const Taken&) = delete;
  Taken& operator=(const Taken&) = delete;

 private:
  Jobs& jobs_;
};

}  // namespace

Site::Json Site::begin_fit(const Json& body) {
  fit::FitRequest request = study_.fit_request(values_in(body));
  const std::string parent = diagnose::file_name(request.model);
  const std::string output = diagnose::file_name(request.output);
  const bool begun = jobs_.fit(
      std::move(request), progress(),
      [this, parent, output](JobResult result) { finish_job(std::move(result), parent, output); });
  if (!begun) throw UsageError("a computation is running already");
  folder_.reserve(output);
  return {{"ok", true}};
}

Site::Json Site::begin_diagnosis(const Json& body) {
  diagnose::DiagnosisRequest request = study_.diagnosis_request(
      texts_in(body, "only"), body.contains("model") ? text_in(body, "model") : "");
  const std::string parent = diagnose::file_name(request.model);
  const std::string output = diagnose::file_name(request.output);
  const bool begun = jobs_.diagnose(
      std::move(request), progress(),
      [this, parent, output](JobResult result) { finish_job(std::move(result), parent, output); });
  if (!begun) throw UsageError("a computation is running already");
  folder_.reserve(output);
  return {{"ok", true}};
}

void Site::finish_job(JobResult result, const std::string& parent, const std::string& output) {
  study_lane_.post_kept([this, result = std::move(result), parent, output] {
    {
      const Taken taken(jobs_);
      keep_result(result, parent, output);
    }
    publish_state();
  });
}

void Site::keep_result(const JobResult& result, const std::string& parent,
                       const std::string& output) {
  if (!unsaved_.empty()) check_folder(false);  // results are taken in their order
  std::string error = result.error;
  try {
    take_result(result, parent);
  } catch (const std::exception& failed) {
    error = failed.what();
    check_folder(true);
    if (!trouble_.empty()) {
      show_result(result.summary);
      last_result_["unsaved"] = error;
      unsaved_.push_back({result, parent});
      return;
    }
  }
  folder_.release(output);
  show_result(error.empty() ? result.summary : Json{{"kind", "error"}, {"words", error}});
}

void Site::show_result(Json result) {
  const bool of_all = result.contains("only") && result["only"].empty();
  if (of_all) {
    last_diagnosis_ = result;
  } else {
    result["before"] = last_diagnosis_;
  }
  last_result_ = std::move(result);
}

void Site::take_unsaved() {
  while (!unsaved_.empty()) {
    const JobResult& result = unsaved_.front().result;
    try {
      take_result(result, unsaved_.front().parent);
      show_result(result.summary);
    } catch (const std::exception& failed) {
      const std::string why = failed.what();
      trouble_ = folder_.trouble(true);
      if (!trouble_.empty()) {
        show_result(unsaved_.back().result.summary);
        last_result_["unsaved"] = why;
        return;
      }
      show_result({{"kind", "error"}, {"words", why}});
    }
    folder_.release(diagnose::file_name(result.model));
    unsaved_.pop_front();
  }
}

void Site::take_result(const JobResult& result, const std::string& parent) {
  if (result.model.empty()) return;
  config::record::write_whole(result.model, result.text);
  study_.take_trial(diagnose::file_name(result.model), parent, result.what, result.command);
}

void Site::end_jobs() {
  jobs_.end();
  study_lane_.post_kept([this] {
    if (!unsaved_.empty()) check_folder(false);
    for (const Unsaved& lost : unsaved_) {
      std::cerr << "spoolwatch serve: " << diagnose::file_name(lost.result.model)
                << ": is not written: " << trouble_ << '\n';
    }
  });
  study_lane_.end();
}

void Site::check_folder(bool failed) {
  const std::string before = std::exchange(trouble_, folder_.trouble(failed || !trouble_.empty()));
  if (trouble_.empty() && !before.empty()) {
    try {
      study_.restore();
    } catch (const config::schema::Error& error) {
      trouble_ = error.what();
    }
    if (trouble_.empty()) take_unsaved();
  }
  if (trouble_ != before) publish_state();
}

void Site::watch_folder() {
  std::unique_lock lock(ends_mutex_);
  while (!ends_soon_.wait_for(lock, kFolderPeriod, [this] { return ends_; })) {
    if (watching_ > 0 && study_lane_.waiting() == 0) {
      study_lane_.post([this] { check_folder(false); });
    }
  }
}

}  // namespace workbench::serve
