// [[distance]]: how far the values of an estimator lie, together, from where they lay when all was
// well (region.h). It sees what no band on one value does: a combination that never occurred.
//
// One block is one decision, so the probability that a healthy block is outside is block length
// over mean time between false alarms. The alarm says which value contributes most.
#pragma once

#include "estimator/fdi/trained.h"

namespace estimator::fdi {

/// Values: distance2 (T^2), limit.
struct DistanceConfig final : TrainedConfig {
  std::vector<std::string> features;  ///< "sliding.a1", "sliding.b1", ...
  double false_alarm_time_s = 86400.0;
  TrainedClass healthy;
  AlarmNaming naming;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] std::vector<std::string> quantities() const override { return features; }
  void adopt(const TrainedSource& trained) override { healthy = *trained.healthy(); }
  [[nodiscard]] const char* list() const override { return "distance"; }
  [[nodiscard]] std::unique_ptr<Source> make(const Setting& setting) const override;
  [[nodiscard]] std::unique_ptr<SourceConfig> clone() const override {
    return std::make_unique<DistanceConfig>(*this);
  }
};

}  // namespace estimator::fdi
