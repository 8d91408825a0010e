// The comparison as JSON; SI units, a missing number is null.
#include <nlohmann/json.hpp>

#include "workbench/present/json.h"
#include "workbench/select/outcome.h"

namespace workbench::select {
namespace {

using nlohmann::ordered_json;
using present::number_or_null;

ordered_json numbers(const std::vector<double>& values) {
  ordered_json out = ordered_json::array();
  for (const double value : values) out.push_back(number_or_null(value));
  return out;
}

ordered_json bias_of(const structures::BiasTest& test) {
  return {{"verdict", to_string(test.verdict)},
          {"p", number_or_null(test.p)},
          {"statistic", number_or_null(test.statistic)},
          {"dof", test.dof},
          {"instruments", to_string(test.instruments)},
          {"instrument_count", test.instrument_count},
          {"strength_F", number_or_null(test.f_statistic)},
          {"least_squares", numbers(test.least_squares)},
          {"least_squares_std_error", numbers(test.least_squares_error)},
          {"instrumental", numbers(test.instrumental)},
          {"instrumental_std_error", numbers(test.instrumental_error)}};
}

ordered_json json_of(const JudgedStructure& one) {
  ordered_json out{{"structure", one.candidate.name},
                   {"family", one.candidate.family()},
                   {"valid", one.fitted.valid},
                   {"why", one.fitted.why},
                   {"represents", one.represents},
                   {"parameters", one.fitted.parameters},
                   {"names", one.fitted.names},
                   {"value", numbers(one.fitted.value)},
                   {"std_error", numbers(one.fitted.std_error)},
                   {"one_step_rms_m", number_or_null(one.one_step_rms_m)},
                   {"free_run_rms_m", number_or_null(one.free_run_rms_m)},
                   {"free_run_whole_rms_m", number_or_null(one.free_run_whole_rms_m)},
                   {"cost_m2", number_or_null(one.cost_m2)},
                   {"period_costs_m2", numbers(one.period_costs_m2)},
                   {"fit_percent", number_or_null(one.fit_percent)},
                   {"aicc", number_or_null(one.aicc)},
                   {"bic", number_or_null(one.bic)},
                   {"whiteness_p", number_or_null(one.whiteness_p)},
                   {"condition", number_or_null(one.fitted.condition)},
                   {"spread", number_or_null(one.spread)},
                   {"period_mean", numbers(one.period_mean)},
                   {"period_variance", numbers(one.period_variance)},
                   {"periods", one.periods},
                   {"on_line",
                    {{"sound", one.on_line.sound},
                     {"method", one.on_line.method},
                     {"why", one.on_line.why},
                     {"free_run_rms_m", number_or_null(one.on_line.free_run_rms_m)}}},
                   {"bias", one.has_bias_test ? bias_of(one.bias) : ordered_json(nullptr)},
                   {"fit_s", number_or_null(one.fit_s)}};
  return out;
}

ordered_json name_of(const SelectOutcome& o, int index) {
  return index < 0 ? ordered_json(nullptr)
                   : ordered_json(o.judged[static_cast<std::size_t>(index)].candidate.name);
}

}  // namespace

std::string to_json(const SelectOutcome& o) {
  ordered_json out{{"record", o.name},
                   {"sample_time_s", o.sample_time_s},
                   {"samples", o.samples},
                   {"gaps", o.gaps},
                   {"delay", o.delay},
                   {"constant", o.request.constant},
                   {"period_s", o.period_s},
                   {"fitted_from_s", o.from_s},
                   {"fitted_to_s", o.fitted_to_s},
                   {"scored_to_s", o.scored_to_s},
                   {"scored_periods", o.held_out_periods},
                   {"noise_floor_m", number_or_null(o.noise_floor_m)},
                   {"recommended", name_of(o, o.recommended)},
                   {"on_line", name_of(o, o.watch)},
                   {"most_accurate", name_of(o, o.most_accurate)},
                   {"reason", o.reason},
                   {"bias", o.bias_words},
                   {"structures", ordered_json::array()},
                   {"notes", o.notes},
                   {"interrupted", o.interrupted},
                   {"runtime_s", number_or_null(o.runtime_s)}};
  for (const JudgedStructure& one : o.judged) out["structures"].push_back(json_of(one));
  return out.dump(2) + "\n";
}

}  // namespace workbench::select
