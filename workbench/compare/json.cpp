#include "workbench/compare/comparison_report.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "workbench/present/disturbance_json.h"
#include "workbench/present/json.h"
#include "workbench/present/resonance_json.h"

namespace workbench::compare {
namespace {

using nlohmann::ordered_json;
using present::number_or_null;

ordered_json json_of(const validation::Bin& bin) {
  ordered_json out{{"from", number_or_null(bin.from)}, {"to", number_or_null(bin.to)}};
  if (!bin.name.empty()) out["name"] = bin.name;
  out["rms_m"] = number_or_null(bin.rms_m);
  out["mean_m"] = number_or_null(bin.mean_m);
  out["samples"] = bin.count;
  out["time_share"] = number_or_null(bin.time_share);
  out["error_share"] = number_or_null(bin.error_share);
  out["speed_error_mps"] = number_or_null(bin.speed_error_mps);
  out["arising_rms_mps"] = number_or_null(bin.local_velocity_error_rms_mps);
  out["arising_share"] = number_or_null(bin.local_velocity_error_share);
  return out;
}

ordered_json json_of(const validation::SignificantRegion& failing) {
  ordered_json out{{"variable", failing.ranges.front().variable}};
  out.update(json_of(failing.figures));
  out["stands_out"] = failing.significant;
  return out;
}

const char* to_string(Judgement judgement) {
  constexpr const char* kTexts[] = {"at_floor", "fails_somewhere", "fails_throughout", "useless"};
  return kTexts[static_cast<std::size_t>(judgement)];
}

}  // namespace

std::string to_json(const validation::Comparison& c, const DisturbanceCheck& check) {
  const Words said = words(c, check);
  ordered_json out;
  out["model"] = c.model;
  out["record"] = c.record.name;
  out["judgement"] = to_string(said.judgement);
  out["verdict"] = said.verdict;
  out["findings"] = said.lines;
  out["rms_m"] = number_or_null(c.rms_m);
  out["free_run_rms_m"] = number_or_null(c.free_run_rms_m);
  out["fit_percent"] = number_or_null(c.fit_percent);
  out["noise_floor_m"] = number_or_null(c.noise_floor_m);
  out["encoder_step_m"] = number_or_null(c.encoder_step_m);
  out["one_step_rms_m"] = number_or_null(c.k_step.front().rms_m);
  out["k_step"] = ordered_json::array();
  for (const validation::KStep& k : c.k_step) {
    out["k_step"].push_back(
        {{"samples", k.samples}, {"rms_m", number_or_null(k.rms_m)}, {"count", k.count}});
  }
  out["whiteness_p"] = number_or_null(c.whiteness_p);
  out["independence_p"] = number_or_null(c.independence_p);
  out["worst"] = ordered_json::array();
  for (const validation::SignificantRegion& failing : c.worst)
    out["worst"].push_back(json_of(failing));
  out["disturbance"] = present::disturbance_json(
      check.found ? std::optional(check.found->disturbance) : std::nullopt);
  out["disturbed_floor_m"] = number_or_null(check.found ? check.found->floor_m : std::nan(""));
  out["resonance"] = present::resonance_json(c.resonance);
  out["gain_ratio"] = number_or_null(c.systematic.gain_ratio);
  out["offset_mps"] = number_or_null(c.systematic.offset_mps);
  out["explained_share"] = number_or_null(c.systematic.share);
  out["regions"] = ordered_json::object();
  for (const validation::Region& region : c.regions) {
    ordered_json bins = ordered_json::array();
    for (const validation::Bin& bin : region.bins) bins.push_back(json_of(bin));
    out["regions"][region.variable] = std::move(bins);
  }
  out["observer_per_s"] = number_or_null(c.observer_per_s);
  out["sample_time_s"] = number_or_null(c.record.sample_time_s);
  out["samples"] = c.record.size();
  out["segments"] = c.record.starts.size();
  out["duration_s"] = number_or_null(c.duration_s());
  out["notes"] = notes(c);
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace workbench::compare
