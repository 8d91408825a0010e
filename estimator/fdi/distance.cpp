#include "estimator/fdi/distance.h"

#include <cmath>
#include <cstdio>

#include "config/schema/error.h"
#include "estimator/fdi/block_source.h"
#include "estimator/fdi/region.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_config;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class Distance final : public BlockSource {
 public:
  Distance(const DistanceConfig& config, const Setting& setting)
      : BlockSource(config.features, config.block_s, setting, config.where()),
        config_(config),
        region_(config.healthy.mean, config.healthy.covariance,
                static_cast<double>(config.healthy.blocks), config.where()) {
    const double p = interval_s() / config.false_alarm_time_s;
    if (!(p > 0.0 && p < 0.5)) {
      throw bad_config(config.where() + ": false_alarm_time_s",
                       "is no multiple of a block, or block_s is missing", "many blocks");
    }
    limit_ = region_.limit(p);
  }
  [[nodiscard]] std::vector<std::string> names() const override { return {"distance2", "limit"}; }
  [[nodiscard]] std::vector<Alarm> own_alarms() const override {
    return {config_.naming.alarm("outside")};
  }
  [[nodiscard]] AlarmState own_alarm(std::size_t /*number*/) const noexcept override {
    AlarmState state;
    state.value = distance2_;
    if (!(distance2_ > limit_)) {
      state.reason = "inside the healthy region";
      return state;
    }
    state.severity = config_.naming.level();
    state.direction = 1;
    std::snprintf(reason_, sizeof reason_,
                  "%.4g away from the healthy region, %.4g is its edge; most by %s",
                  std::sqrt(distance2_), std::sqrt(limit_), config_.features[most_].c_str());
    state.reason = reason_;
    return state;
  }

 private:
  void take(std::span<const double> means) noexcept override {
    distance2_ = region_.distance2(means);
    most_ = region_.most();
  }
  void show(std::span<NamedValue> values) const noexcept override {
    values[0].value = valid() ? distance2_ : kNan;
    values[1].value = limit_;
  }
  void forget() noexcept override { distance2_ = 0.0, most_ = 0; }
  void serialize_state(StateArchive& archive) override {
    archive.value(distance2_);
    archive.value(most_);
    if (most_ >= config_.features.size()) most_ = 0, archive.fail();
  }

  DistanceConfig config_;
  Region region_;
  double limit_ = 0.0;
  double distance2_ = 0.0;
  std::size_t most_ = 0;
  mutable char reason_[200] = "";
};

}  // namespace

void DistanceConfig::visit(config::schema::Visitor& v) {
  visit_trained(v);
  v.texts({"features", "the values taken together", true}, features);
  v.number({"false_alarm_time_s", "mean time between false alarms"}, false_alarm_time_s,
           {1e-3, 1e10});
  naming.visit(v);
  bool trained = !healthy.mean.empty();
  v.optional_table({"healthy", "where they lay when all was well"}, trained,
                   [this](config::schema::Visitor& t) {
                     healthy.name = Trained::kHealthy;
                     healthy.visit(t);
                   });
}

std::unique_ptr<Source> DistanceConfig::make(const Setting& setting) const {
  if (features.empty()) throw bad_config(where() + ": features", "is empty");
  if (healthy.mean.size() != features.size()) {
    throw bad_config(where(), "is not trained", "file, from spoolwatch train");
  }
  return std::make_unique<Distance>(*this, setting);
}

}  // namespace estimator::fdi
