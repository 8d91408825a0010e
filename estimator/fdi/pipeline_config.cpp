#include "estimator/fdi/pipeline_config.h"

#include <algorithm>
#include <cmath>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "estimator/fdi/learned_bands.h"
#include "estimator/fdi/quantity.h"
#include "estimator/fdi/snapshot.h"
#include "estimator/fdi/trained.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_config;
using config::schema::Visitor;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLongest_s = 1e5;

const EstimatorConfig* find(const std::vector<EstimatorConfig>& estimators, std::string_view id) {
  for (const EstimatorConfig& estimator : estimators) {
    if (estimator.id == id) return &estimator;
  }
  return nullptr;
}

void apply(const LearnedBand& learned, std::vector<BandConfig>& bands) {
  bool taken = false;
  for (BandConfig& band : bands) {
    if (band.quantity != learned.quantity) continue;
    if (!std::isinf(band.low) || !std::isinf(band.high)) continue;
    band.low = learned.low;
    band.high = learned.high;
    if (band.hysteresis == 0.0) band.hysteresis = learned.hysteresis;
    taken = true;
  }
  if (taken) return;
  BandConfig band;
  band.id = learned.quantity + ".learned";
  band.quantity = learned.quantity;
  band.low = learned.low;
  band.high = learned.high;
  band.hysteresis = learned.hysteresis;
  bands.push_back(std::move(band));
}

}  // namespace

void EstimatorConfig::visit(Visitor& v) {
  v.text({"id", "name; prefix of its quantities: ID.b1", true}, id);
  v.text({"structure", "arx111, arx(2,1,1), ..."}, structure);
  v.choice({"method", "batch is a tumbling window"}, method, {"batch", "sliding", "recursive"});
  v.boolean({"constant", "estimate a constant term"}, constant);
  v.boolean({"increments", "y minus its previous value in the place of y"}, increments);
  v.number({"window_s", "length of the window"}, window_s, {1e-4, kLongest_s});
  v.number({"stride_s", "time between estimates, sliding and recursive"}, stride_s,
           {1e-4, kLongest_s});
  v.number({"offset_m", "subtracted from y"}, offset_m, {-1e3, 1e3});
  v.choice({"detrend", "removed from each batch window"}, detrend, {"none", "mean", "linear"});
  v.choice({"filter", "filter of both u and y"}, filter, {"none", "low", "high", "band"});
  v.number({"filter_low_Hz", "lower edge, of high and band"}, filter_low_Hz, {0.0, 1e5});
  v.number({"filter_high_Hz", "upper edge, of low and band"}, filter_high_Hz, {0.0, 1e5});
  v.integer({"decimation", "decimation factor"}, decimation, {1, 1000});
  v.number({"forgetting", "forgetting factor per sample, recursive"}, forgetting, {0.5, 1.0});
  v.number({"prior_variance", "P(0) = C I, recursive"}, prior_variance, {1e-12, 1e15});
  v.number({"first_batch_s", "length of an initial batch, recursive"}, first_batch_s,
           {0.0, kLongest_s});
  v.number({"warmup_s", "no band acts before"}, warmup_s, {0.0, kLongest_s});
  v.number({"min_u_rms_V", "less command is not excited"}, min_u_rms_V, {0.0, 1e3});
  v.number({"max_condition", "largest condition of the scaled regressors"}, max_condition,
           {1.0, 1e15});
  v.number({"max_saturated", "share of saturated samples in a window"}, max_saturated, {0.0, 1.0});
  v.number({"max_missing", "share of missing samples in a window"}, max_missing, {0.0, 1.0});
}

std::string EstimatorConfig::fingerprint() const {
  EstimatorConfig copy = *this;
  copy.id.clear();
  copy.warmup_s = 0.0;
  return one_line(config::schema::print_toml([&](Visitor& v) { copy.visit(v); }));
}

PipelineConfig::PipelineConfig(std::span<const DetectionMethodKind> more) {
  for (const DetectionMethodKind& kind : detection_method_kinds()) methods.emplace_back(kind);
  for (const DetectionMethodKind& kind : more) methods.emplace_back(kind);
}

void PipelineConfig::add(std::string_view list, std::unique_ptr<DetectionMethodConfig> source) {
  const auto found =
      std::find_if(methods.begin(), methods.end(),
                   [&](const DetectionMethodList& each) { return each.kind.list == list; });
  if (found == methods.end()) throw bad_config(std::string(list), "is no kind of source");
  found->items.push_back(std::move(source));
}

std::vector<std::string> PipelineConfig::method_ids() const {
  std::vector<std::string> ids;
  for (const EstimatorConfig& estimator : estimators) ids.push_back(estimator.id);
  for (const DetectionMethodList& list : methods) {
    for (const auto& item : list.items) ids.push_back(item->id);
  }
  return ids;
}

const DetectionMethodConfig* PipelineConfig::find_method(std::string_view id) const noexcept {
  for (const DetectionMethodList& list : methods) {
    for (const auto& item : list.items) {
      if (item->id == id) return item.get();
    }
  }
  return nullptr;
}

std::string PipelineConfig::fingerprint(std::string_view id) const {
  if (const EstimatorConfig* estimator = find(estimators, id)) return estimator->fingerprint();
  const DetectionMethodConfig* source = find_method(id);
  return source != nullptr ? source->fingerprint() : "";
}

bool PipelineConfig::owns(std::string_view key) const {
  if (key == "bands_file" || key.starts_with("[[estimator]]") || key.starts_with("[[band]]")) {
    return true;
  }
  return std::any_of(methods.begin(), methods.end(), [&](const DetectionMethodList& each) {
    const std::string list = std::string("[[") + each.kind.list;
    return key.starts_with(list + "]]") || key.starts_with(list + ".");
  });
}

void PipelineConfig::visit(Visitor& v) {
  v.path({"bands_file", "learned bands, relative to this file's folder"}, bands_file, "bands.toml");
  config::schema::visit_list(v, {"estimator", "estimators"}, estimators);
  for (DetectionMethodList& list : methods) list.visit(v);
  config::schema::visit_list(v, {"band", "alarm bands"}, bands);
}

void LearnedBand::visit(Visitor& v) {
  v.text({"quantity", "quantity of the band", true}, quantity);
  v.text({"structure", "structure of the estimator", true}, structure);
  v.text({"estimator", "settings of the estimator", true}, estimator);
  v.number({"low", "", true}, low);
  v.number({"high", "", true}, high);
  v.number({"hysteresis"}, hysteresis, {0.0, kInfinity});
  v.number({"centre", "mean of the healthy estimates"}, centre);
  v.integer({"estimates", "number of estimates"}, estimates);
  v.number({"block_s", "length of the blocks fitted"}, block_s);
}

void LearnedBands::visit(Visitor& v) {
  v.number({"sample_time_s", "sample time of the healthy record", true}, sample_time_s,
           {1e-6, 1e3});
  v.text({"source", "the healthy record"}, source);
  v.number({"false_alarm_time_s", "mean time between false alarms aimed at"}, false_alarm_time_s);
  config::schema::visit_list(v, {"learned", "bands"}, bands);
}

void PipelineConfig::load_bands(const std::filesystem::path& folder, double sample_time_s,
                                const std::string& rig_id) {
  for (DetectionMethodList& list : methods) {
    for (const auto& item : list.items) item->load({folder, sample_time_s, rig_id, *this});
  }
  if (bands_file.empty()) return;
  const std::filesystem::path file = folder / bands_file;
  const auto open = [](const BandConfig& band) {
    return std::isinf(band.low) && std::isinf(band.high);
  };
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown) && std::any_of(bands.begin(), bands.end(), open)) {
    std::erase_if(bands, open);  // nothing has been learned yet
    return;
  }
  LearnedBands learned;
  config::schema::Document::load(file).read([&](Visitor& v) { learned.visit(v); });
  if (std::abs(learned.sample_time_s - sample_time_s) > kSameSampleTime_ratio * sample_time_s) {
    throw bad_config(file.string() + ": sample_time_s",
                     "bands were learned at " + std::to_string(learned.sample_time_s) +
                         " s, the samples come every " + std::to_string(sample_time_s) + " s",
                     "bands learned at the same sample time");
  }
  for (const LearnedBand& band : learned.bands) {
    const std::string where = file.string() + ": [[learned]] " + band.quantity;
    const EstimatorConfig* estimator = find(estimators, split_quantity(band.quantity).source);
    if (estimator == nullptr) {
      throw bad_config(where, "there is no such estimator", "the id of an [[estimator]]");
    }
    if (estimator->fingerprint() != band.estimator) {
      const FingerprintDifference differs = difference(band.estimator, estimator->fingerprint());
      throw bad_config(where, "was learned with other settings of the estimator: " + differs.found,
                       differs.expected);
    }
    apply(band, bands);
  }
  if (learned.bands.empty()) std::erase_if(bands, open);
}

}  // namespace estimator::fdi
