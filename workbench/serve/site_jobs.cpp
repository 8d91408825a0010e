// Fits and diagnoses that a page begins, what becomes of their results, and the folder that these
// are written to, which may be full or gone when they end.
#include <chrono>
#include <filesystem>
#include <mutex>
#include <utility>

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "workbench/serve/request_fields.h"
#include "workbench/serve/site.h"

namespace workbench::serve {
namespace {

using config::schema::UsageError;

constexpr std::chrono::seconds kFolderPeriod{1};

}  // namespace

Site::Json Site::begin_fit(const Json& body) {
  fit::FitRequest request = study_.fit_request(values_in(body));
  const std::string parent = std::filesystem::path(request.model).filename().string();
  const bool begun = jobs_.fit(std::move(request), progress(), [this, parent](JobResult result) {
    finish_job(std::move(result), parent);
  });
  if (!begun) throw UsageError("a computation is running already");
  return {{"ok", true}};
}

Site::Json Site::begin_diagnosis(const Json& body) {
  diagnose::DiagnosisRequest request = study_.diagnosis_request(texts_in(body, "only"));
  const std::string parent = std::filesystem::path(request.model).filename().string();
  const bool begun =
      jobs_.diagnose(std::move(request), progress(),
                     [this, parent](JobResult result) { finish_job(std::move(result), parent); });
  if (!begun) throw UsageError("a computation is running already");
  return {{"ok", true}};
}

void Site::finish_job(JobResult result, const std::string& parent) {
  study_lane_.post([this, result = std::move(result), parent] {
    last_result_ = result.summary;
    std::string error = result.error;
    unsaved_.reset();
    try {
      take_result(result, parent);
    } catch (const std::exception& failed) {
      error = failed.what();
      check_folder(true);
      if (!trouble_.empty()) {
        last_result_["unsaved"] = error;
        error.clear();
        unsaved_ = {result, parent};
      }
    }
    if (!error.empty()) last_result_ = {{"kind", "error"}, {"words", error}};
    publish_state();
  });
}

void Site::take_unsaved() {
  try {
    take_result(unsaved_->result, unsaved_->parent);
    last_result_ = unsaved_->result.summary;
  } catch (const std::exception& failed) {
    const std::string why = failed.what();
    trouble_ = folder_.trouble(true);
    if (!trouble_.empty()) return;
    last_result_ = {{"kind", "error"}, {"words", why}};
  }
  unsaved_.reset();
}

void Site::take_result(const JobResult& result, const std::string& parent) {
  if (result.model.empty()) return;
  config::record::write_whole(result.model, result.text);
  const std::string model = std::filesystem::path(result.model).filename().string();
  study_.take_trial(model, parent, result.what, result.command);
}

void Site::check_folder(bool failed) {
  const std::string before = std::exchange(trouble_, folder_.trouble(failed || !trouble_.empty()));
  if (trouble_.empty() && !before.empty()) {
    try {
      study_.restore();
    } catch (const config::schema::Error& error) {
      trouble_ = error.what();
    }
    if (trouble_.empty() && unsaved_) take_unsaved();
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
