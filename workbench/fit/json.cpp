// A fit as JSON.
#include <cmath>
#include <nlohmann/json.hpp>

#include "estimator/greybox/held_scale.h"
#include "workbench/fit/fit_report.h"
#include "workbench/present/held_scale_json.h"
#include "workbench/present/json.h"

namespace workbench::fit {
namespace {

using nlohmann::ordered_json;
using present::number_or_null;

ordered_json json_of(const greybox::EstimatedParameter& p) {
  ordered_json out;
  out["value"] = number_or_null(p.value);
  out["std_error"] = number_or_null(p.std_error);
  out["low"] = number_or_null(p.low);
  out["high"] = number_or_null(p.high);
  out["at_bound"] = p.at_bound;
  out["start"] = number_or_null(p.start);
  const bool prior = std::isfinite(p.free.prior_sd);
  const double mean = p.free.to_physical(p.free.prior_mean);
  out["prior_mean"] = prior ? number_or_null(mean) : nullptr;
  out["prior_sd"] =
      prior ? number_or_null(p.free.prior_sd * p.free.slope(p.free.prior_mean)) : nullptr;
  out["record_share"] = number_or_null(p.record_share);
  out["interval"] = p.from_profile ? "profile" : "normal";
  out["remark"] = remark(p);
  if (!p.profile.empty()) {
    out["profile"] = ordered_json::array();
    for (const auto& point : p.profile) {
      out["profile"].push_back(
          {{"value", number_or_null(point.value)}, {"rise", number_or_null(point.rise)}});
    }
    out["low_found"] = p.low_found;
    out["high_found"] = p.high_found;
  }
  return out;
}

ordered_json json_of(const greybox::IdentifiabilityReport& report,
                     const std::vector<greybox::EstimatedParameter>& parameters) {
  ordered_json out{{"condition", number_or_null(report.condition)},
                   {"unseen", ordered_json::array()}};
  for (const greybox::UnidentifiableParameter& unseen : report.unidentifiable) {
    ordered_json partners = ordered_json::array();
    for (const std::size_t i : unseen.partners) partners.push_back(parameters[i].free.name);
    out["unseen"].push_back({{"parameter", parameters[unseen.parameter].free.name},
                             {"partners", partners},
                             {"visible", visible_words(unseen, parameters)},
                             {"words", unidentifiable_words(unseen, parameters)}});
  }
  return out;
}

}  // namespace

std::string to_json(const FitReport& o) {
  const greybox::EstimationSummary& e = o.estimation;
  ordered_json out;
  out["model"] = o.prepared->problem.model.name;
  out["records"] = ordered_json::array();
  for (const auto& record : o.prepared->problem.data.records) out["records"].push_back(record.name);
  out["words"] = words(o);
  out["rms_before_m"] = number_or_null(e.before.rms_m);
  out["rms_after_m"] = number_or_null(e.after.rms_m);
  out["heldout_before_m"] = number_or_null(e.before.heldout_rms_m);
  out["heldout_after_m"] = number_or_null(e.after.heldout_rms_m);
  out["free_run_before_m"] = number_or_null(e.before.free_run_rms_m);
  out["free_run_after_m"] = number_or_null(e.after.free_run_rms_m);
  out["fit_percent_before"] = number_or_null(e.before.fit_percent);
  out["fit_percent_after"] = number_or_null(e.after.fit_percent);
  out["noise_floor_m"] = number_or_null(o.noise_floor_m);
  out["sigma_m"] = number_or_null(e.fitted.sigma_m);  // that weighted the squared residuals
  out["effective_samples"] = number_or_null(e.effective_samples);
  for (const greybox::EstimatedParameter& p : e.parameters)
    out["parameters"][p.free.name] = json_of(p);
  out["starts"] = {{"tried", e.starts.tried},
                   {"same", e.starts.same},
                   {"elsewhere", e.starts.elsewhere},
                   {"worse", e.starts.worse}};
  out["identifiability"] = {{"before", json_of(e.identifiability_before, e.parameters)},
                            {"after", json_of(e.identifiability_after, e.parameters)}};
  out["held_scale"] = present::json_of(greybox::held_scale(e.better, fitted_names(e)));
  ordered_json names = ordered_json::array();
  ordered_json matrix = ordered_json::array();
  for (Eigen::Index i = 0; i < e.correlation.rows(); ++i) {
    names.push_back(e.parameters[static_cast<std::size_t>(i)].free.name);
    ordered_json row = ordered_json::array();
    for (Eigen::Index j = 0; j < e.correlation.cols(); ++j)
      row.push_back(number_or_null(e.correlation(i, j)));
    matrix.push_back(row);
  }
  out["correlation"] = {{"names", names}, {"matrix", matrix}};
  out["observer_per_s"] = number_or_null(o.prepared->options.observer_per_s);
  out["interrupted"] = e.interrupted;
  out["notes"] = o.prepared->notes;
  out["command"] = o.prepared->command;
  out["evaluations"] = e.evaluations;
  out["fit_s"] = number_or_null(e.fit_s);
  out["runtime_s"] = number_or_null(o.runtime_s);
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace workbench::fit
