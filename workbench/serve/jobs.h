// The one long computation of a session: a fit or a diagnosis, with progress and a way to stop it.
// No page owns it: it goes on when all are closed.
#pragma once

#include <atomic>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "workbench/diagnose/request.h"
#include "workbench/fit/request.h"
#include "workbench/serve/lane.h"

namespace workbench::serve {

/// A finished job leaves its result here.
// NOLINTNEXTLINE(bugprone-exception-escape): moving ordered_json may throw by its type alone
struct JobResult {
  std::string error;               ///< empty: none
  std::string model;               ///< the file to be written, with its path; empty: none
  std::string text;                ///< the file's content
  std::string what;                ///< "fitted", "+ friction"
  std::string command;             ///< the command line that does the same
  nlohmann::ordered_json summary;  ///< for the page; null: none
};

class Jobs {
 public:
  /// Called on the job's thread; must return soon.
  using Progress = std::function<void(const std::string& text, int done, int of)>;
  using Done = std::function<void(JobResult result)>;

  /// False where one runs already; nothing is then begun.
  bool fit(fit::FitRequest request, Progress progress, const Done& done);
  bool diagnose(diagnose::DiagnosisRequest request, Progress progress, const Done& done);
  /// Asks the running one to end with the best so far.
  void cancel() { cancelled_ = true; }
  /// True from the beginning of a job until its result is taken.
  [[nodiscard]] bool running() const { return running_; }
  /// Says that the result of the job has been taken: another may begin.
  void taken() { running_ = false; }
  /// Stops the running one and waits for it.
  void end() {
    cancel();
    lane_.end();
  }

 private:
  bool begin(std::function<JobResult()> work, const Done& done);

  std::atomic<bool> running_{false};
  std::atomic<bool> cancelled_{false};
  Lane lane_;
};

}  // namespace workbench::serve
