#include "workbench/serve/jobs.h"

#include <cmath>
#include <mutex>
#include <new>

#include "config/record/whole_file.h"
#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/diagnose/effect_words.h"
#include "workbench/diagnose/words.h"
#include "workbench/fit/fit_report.h"
#include "workbench/present/json.h"
#include "workbench/present/printed_axis.h"
#include "workbench/present/text.h"

namespace workbench::serve {
namespace {

using nlohmann::ordered_json;
using present::number_or_null;
using present::typeset;
using present::typeset_all;
namespace selection = estimator::greybox::selection;

std::string length(double value_m) { return typeset(config::units::length_words(value_m)); }

/// The candidates of all rounds with the error that each would reach.
ordered_json candidates_of(const selection::Diagnosis& diagnosis) {
  ordered_json out = ordered_json::array();
  const auto& rounds = diagnosis.search.rounds;
  for (std::size_t r = 0; r < rounds.size(); ++r) {
    for (const selection::Candidate& one : rounds[r].candidates) {
      if (!one.fitted_at_all || !std::isfinite(one.validation_rms_m)) continue;
      // To reach that error, what the rounds before have taken is needed too.
      std::vector<std::string> with = rounds[r].before.added;
      with.insert(with.end(), one.effects.begin(), one.effects.end());
      out.push_back({{"round", r + 1},
                     {"only", with},
                     {"effect", config::schema::joined(one.effects, "+")},
                     {"heldout_m", number_or_null(one.validation_rms_m)},
                     {"heldout", length(one.validation_rms_m)},
                     {"chance", typeset(config::units::chance_words(one.p_value))}});
    }
  }
  return out;
}

ordered_json laws_of(const selection::Diagnosis& diagnosis) {
  ordered_json out = ordered_json::array();
  for (const selection::Law& law : diagnosis.laws) {
    out.push_back({{"name", law.effect.name},
                   {"what", law.effect.what},
                   {"formula", law.effect.formula},
                   {"values", typeset(diagnose::effect_words(diagnosis, law.effect.name))}});
  }
  return out;
}

ordered_json summary_of(const diagnose::DiagnosisReport& report) {
  const selection::Diagnosis& d = report.diagnosis;
  ordered_json out{{"kind", "diagnosis"}, {"words", typeset(diagnose::verdict_words(d))}};
  out["verdict"] = selection::to_string(d.verdict);
  out["remarks"] = typeset_all(diagnose::remarks(report));
  out["steps"] = ordered_json::array();
  if (report.fitted()) {
    for (const diagnose::StepWords& step : diagnose::step_words(d)) {
      out["steps"].push_back({{"what", step.what},
                              {"heldout_m", number_or_null(step.rms_m)},
                              {"heldout", length(step.rms_m)}});
    }
  }
  out["noise_floor_m"] = number_or_null(d.noise_floor_m);
  out["noise_floor"] = length(d.noise_floor_m);
  out["candidates"] = candidates_of(d);
  out["laws"] = laws_of(d);
  out["interrupted"] = report.interrupted;
  return out;
}

ordered_json summary_of(const fit::FitReport& report) {
  ordered_json out{{"kind", "fit"}, {"words", ""}, {"remarks", ordered_json::array()}};
  const std::vector<std::string> words = fit::words(report);
  if (!words.empty()) {
    out["words"] = typeset(words.front());
    out["remarks"] = typeset_all({words.begin() + 1, words.end()});
  }
  out["interrupted"] = report.estimation.interrupted;
  return out;
}

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
    running_ = false;
    done(std::move(result));
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
        config::record::write_whole(request.output, fit::to_model(report));
        return JobResult{"", request.output, "fitted", request.command, summary_of(report)};
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
          if (!now.best.empty()) text += "; best " + now.best + " " + length(now.best_rms_m);
          progress(text, now.done, now.of);
        };
        const diagnose::DiagnosisReport report =
            diagnose::run(prepared, [this] { return cancelled_.load(); });
        JobResult result{"", "", "", request.command, summary_of(report)};
        if (!report.fitted()) return result;
        config::record::write_whole(request.output, diagnose::better_model_text(report));
        result.model = request.output;
        const auto& missing = report.diagnosis.missing;
        result.what = missing.empty() ? "fitted" : "+ " + config::schema::joined(missing, " + ");
        return result;
      },
      done);
}

}  // namespace workbench::serve
