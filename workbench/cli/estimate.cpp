// `spoolwatch estimate RECORD`: an ARX structure fitted to a record, as text or JSON.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/cli/number_check.h"
#include "workbench/estimate/estimate_fit.h"
#include "workbench/present/json.h"

namespace workbench::cli {
namespace {

using nlohmann::ordered_json;

struct EstimateCommandOptions {
  std::string record;
  config::record::ReadOptions reading;
  std::string structure = "arx211";
  bool constant = false;
  std::string fit = "all";
  std::string json;
  estimate::EstimateOptions estimate;
  CLI::Option* forgetting = nullptr;
  CLI::Option* prior_variance = nullptr;
};

/// Refuses options that the method or the filter would silently ignore.
void refuse_unused(const EstimateCommandOptions& options) {
  const estimate::EstimateOptions& e = options.estimate;
  const auto refuse = [](bool given, const std::string& option, const std::string& beside) {
    if (!given) return;
    throw config::schema::UsageError(option + ": has no use with " + beside);
  };
  const std::string method = "--method " + e.method;
  const std::string filter = "--filter " + e.filter;
  const bool recursive = e.method == "recursive";
  refuse(!std::isnan(e.stride_s) && e.method == "batch", "--stride", method);
  refuse(!std::isnan(e.window_s) && recursive, "--window", method);
  refuse(options.forgetting->count() > 0 && !recursive, "--forgetting", method);
  refuse(options.prior_variance->count() > 0 && !recursive, "--prior-variance", method);
  const bool high = e.filter == "high" || e.filter == "band";
  const bool low = e.filter == "low" || e.filter == "band";
  refuse(!std::isnan(e.filter_low_Hz) && !high, "--filter-low-Hz", filter);
  refuse(!std::isnan(e.filter_high_Hz) && !low, "--filter-high-Hz", filter);
}

ordered_json coefficients(const std::array<double, estimator::kMaxCoefficients>& values, int begin,
                          int count) {
  return std::vector<double>(values.begin() + begin, values.begin() + begin + count);
}

/// The keys that the whole record and each window share.
void add_fields(ordered_json& out, const estimate::JudgedEstimate& judged,
                const estimator::Structure& structure) {
  const estimator::Estimate& e = judged.estimate;
  out["a"] = coefficients(e.value, 0, structure.n);
  out["b"] = coefficients(e.value, structure.n, structure.m);
  out["constant"] =
      structure.constant ? ordered_json(e.value[structure.size() - 1]) : ordered_json(nullptr);
  out["std_error"] = {{"a", coefficients(e.std_error, 0, structure.n)},
                      {"b", coefficients(e.std_error, structure.n, structure.m)}};
  out["condition"] = e.condition;
  out["cost_m2"] = judged.cost_m2;
  out["one_step_rms_m"] = judged.one_step_rms_m;
  out["free_run_rms_m"] = judged.free_run_rms_m;
  out["valid"] = e.valid;
  out["reason"] = to_string(e.reason);
  out["from_s"] = judged.from_s;
  out["to_s"] = judged.to_s;
}

ordered_json to_json(const estimate::EstimateResult& result, const EstimateCommandOptions& options,
                     const config::record::Record& record) {
  ordered_json out;
  out["structure"] = options.estimate.structure.text();
  out["method"] = options.estimate.method;
  add_fields(out, result.whole, options.estimate.structure);
  out["scored_from_s"] = result.scored_from_s;
  out["scored_to_s"] = result.scored_to_s;
  out["sample_time_s"] = record.sample_time_s * options.estimate.decimation;
  out["samples"] = record.size();
  out["gaps"] = record.gaps.size();
  out["windows"] = ordered_json::array();
  for (const estimate::JudgedEstimate& window : result.windows) {
    ordered_json item;
    add_fields(item, window, options.estimate.structure);
    out["windows"].push_back(std::move(item));
  }
  return out;
}

void print_text(const estimate::EstimateResult& result, const EstimateCommandOptions& options,
                const config::record::Record& record) {
  const estimator::Structure& structure = options.estimate.structure;
  const estimator::Estimate& e = result.whole.estimate;
  std::printf("%s, %s, %zu samples every %.6g s, %zu gaps\n", structure.text().c_str(),
              options.estimate.method.c_str(), record.size(), record.sample_time_s,
              record.gaps.size());
  const std::vector<std::string> names = structure.names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::printf("  %-9s %14.7g +- %.2g\n", names[i].c_str(), e.value[i], e.std_error[i]);
  }
  std::printf(
      "  condition %.4g; scored from %.6g s to %.6g s: cost %.6g m2, one step %.4g mm, "
      "free run %.4g mm\n",
      e.condition, result.scored_from_s, result.scored_to_s, result.whole.cost_m2,
      1e3 * result.whole.one_step_rms_m, 1e3 * result.whole.free_run_rms_m);
  if (!e.valid) std::printf("  NOT VALID: %s\n", to_string(e.reason));
  if (!result.windows.empty()) {
    std::printf("%10s %10s", "from_s", "to_s");
    for (const std::string& name : names) std::printf(" %14s", name.c_str());
    std::printf(" %12s\n", "cost_m2");
  }
  for (const estimate::JudgedEstimate& window : result.windows) {
    std::printf("%10.4f %10.4f", window.from_s, window.to_s);
    for (std::size_t i = 0; i < names.size(); ++i) std::printf(" %14.7g", window.estimate.value[i]);
    std::printf(" %12.5g %s\n", window.cost_m2, to_string(window.estimate.reason));
  }
}

void run(EstimateCommandOptions options) {
  using config::schema::UsageError;
  options.estimate.structure = estimator::parse_structure(options.structure, options.constant);
  if (options.fit == "first-half") options.estimate.fit_to = 0.5;
  if (options.fit == "second-half") options.estimate.fit_from = 0.5;
  if (!(options.estimate.fit_from < options.estimate.fit_to)) {
    throw UsageError("--fit-from: is not before --fit-to");
  }
  if (options.estimate.method == "sliding" && std::isnan(options.estimate.window_s)) {
    throw UsageError("--method sliding: needs --window S");
  }
  if (options.estimate.stride_s > options.estimate.window_s) {
    throw UsageError("--stride: is longer than --window");
  }
  refuse_unused(options);
  const config::record::Record record =
      config::record::read_record(options.record, options.reading);
  for (const std::string& note : record.notes) {
    std::cerr << "spoolwatch: " << record.name << ": " << note << '\n';
  }
  const estimate::EstimateResult result = estimate::estimate_record(record, options.estimate);
  if (options.json.empty()) {
    print_text(result, options, record);
    return;
  }
  present::write_json(to_json(result, options, record).dump(2) + "\n", options.json);
}

}  // namespace

void add_estimate(CLI::App& command, int& /*exit_code*/) {
  auto options = std::make_shared<EstimateCommandOptions>();
  estimate::EstimateOptions& e = options->estimate;
  add_record(command, options->record);
  add_reading(command, options->reading);
  command.add_option("--structure", options->structure, "arx211, arx(10,2,1), ...")
      ->capture_default_str();
  command.add_option("--method", e.method, "estimation method")
      ->check(CLI::IsMember({"batch", "sliding", "recursive"}))
      ->capture_default_str();
  command.add_flag("--constant", options->constant, "estimate a constant term");
  command
      .add_option("--window", e.window_s,
                  "s; batch: one estimate for each; without it the whole record")
      ->check(positive_number());
  command.add_option("--stride", e.stride_s, "s: time between estimates, sliding and recursive")
      ->check(positive_number());
  options->forgetting =
      command.add_option("--forgetting", e.forgetting, "forgetting factor per sample, recursive")
          ->check(number_within(0.5, 1.0))
          ->capture_default_str();
  options->prior_variance =
      command.add_option("--prior-variance", e.prior_variance, "P(0) = C I, recursive")
          ->check(positive_number())
          ->capture_default_str();
  command.add_option("--detrend", e.detrend, "trend removed from u and y of the whole record")
      ->check(CLI::IsMember({"none", "mean", "linear"}))
      ->capture_default_str();
  command.add_option("--offset-m", e.offset_m, "subtracted from y")
      ->check(finite_number())
      ->capture_default_str();
  command.add_option("--filter", e.filter, "filter of both u and y: Butterworth, order 4")
      ->check(CLI::IsMember({"none", "low", "high", "band"}))
      ->capture_default_str();
  command.add_option("--filter-low-Hz", e.filter_low_Hz, "lower corner frequency of high and band")
      ->check(positive_number());
  command
      .add_option("--filter-high-Hz", e.filter_high_Hz, "upper corner frequency of low and band")
      ->check(positive_number());
  command
      .add_option("--decimate", e.decimation,
                  "decimation factor; a low-pass filter is applied first")
      ->check(number_within(1, 1000))
      ->capture_default_str();
  CLI::Option* const fit =
      command
          .add_option("--fit", options->fit,
                      "part that is fitted; errors are scored on the other part")
          ->check(CLI::IsMember({"all", "first-half", "second-half"}))
          ->capture_default_str();
  command.add_option("--fit-from", e.fit_from, "the same as a share of the record")
      ->check(number_within(0.0, 1.0))
      ->excludes(fit);
  command.add_option("--fit-to", e.fit_to, "the same as a share of the record")
      ->check(number_within(0.0, 1.0))
      ->excludes(fit);
  add_json(command, options->json);
  command.callback([options] { run(*options); });
}

}  // namespace workbench::cli
