#include "workbench/serve/jobs.h"

#include <new>

#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/diagnose/words.h"
#include "workbench/fit/fit_report.h"
#include "workbench/present/printed_axis.h"
#include "workbench/present/text.h"
#include "workbench/serve/job_summary.h"

namespace workbench::serve {
namespace {

namespace selection = estimator::greybox::selection;

}  // namespace

bool Jobs::begin(std::function<JobResult()> work, const Done& done) {
  if (running_.exchange(true)) return false;
  cancelled_ = false;
  lane_.post([this, work = std::move(work), done] {
    JobResult result;
    try {
      result = work();
    } catch (const std::bad_alloc&) {
      result.error = "not enough memory for this record";
    } catch (const std::exception& error) {
      result.error = error.what();
    } catch (...) {
      result.error = "the computation failed";
    }
    try {
      done(std::move(result));
    } catch (...) {  // nobody will take it
      running_ = false;
      throw;
    }
  });
  return true;
}

bool Jobs::fit(fit::FitRequest request, Progress progress, const Done& done) {
  return begin(
      [this, request = std::move(request), progress = std::move(progress)]() mutable {
        fit::PreparedFit prepared = fit::prepare(request);
        const present::PrintedAxis axis(present::motion_of(prepared.problem.model));
        prepared.options.cancel = [this] { return cancelled_.load(); };
        prepared.options.progress = [&](const estimator::greybox::EstimationProgress& now) {
          progress(fit::progress_words(now), 0, 0);
        };
        const fit::FitReport report = fit::run(prepared);
        return JobResult{"",       request.output,  fit::to_model(report),
                         "fitted", request.command, summary_of(report)};
      },
      done);
}

bool Jobs::diagnose(diagnose::DiagnosisRequest request, Progress progress, const Done& done) {
  return begin(
      [this, request = std::move(request), progress = std::move(progress)]() mutable {
        diagnose::PreparedDiagnosis prepared = diagnose::prepare(request);
        const config::units::Motion motion = present::motion_of(prepared.problem.model);
        const present::PrintedAxis axis(motion);
        prepared.options.cancel = [this] { return cancelled_.load(); };
        prepared.options.progress = [&](const selection::SearchProgress& now) {
          const present::PrintedAxis here(motion);  // on whichever thread this is called
          std::string text = "round " + std::to_string(now.round) +
                             (now.screening ? ": screening " : ": fitting ") + now.effect;
          if (!now.best.empty())
            text += "; best " + now.best + " " +
                    present::typeset(config::units::length_words(now.best_rms_m));
          progress(text, now.done, now.of);
        };
        const diagnose::DiagnosisReport report =
            diagnose::run(prepared, [this] { return cancelled_.load(); });
        JobResult result{"", "", "", "", request.command, summary_of(report)};
        result.summary["only"] = request.only;
        result.summary["model"] = diagnose::file_name(request.model);
        result.summary["record"] = diagnose::file_name(request.records.front());
        if (!report.has_better_model()) return result;
        result.model = request.output;
        result.text = diagnose::better_model_text(report);
        const auto& missing = report.diagnosis.missing;
        result.what = missing.empty() ? "fitted" : "+ " + config::schema::joined(missing, " + ");
        return result;
      },
      done);
}

}  // namespace workbench::serve
