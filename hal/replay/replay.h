// A recorded experiment as a device: position and command both come from the record, nothing is
// written. The period of the loop is the record's; a period that the record lacks reads as missing.
#pragma once

#include <vector>

#include "config/record/record.h"
#include "hal/backend.h"

namespace hal::replay {

/// TOML [replay].
struct ReplayConfig {
  std::string record;
  std::string pace = "recorded";

  void visit(config::schema::Visitor& v);
};

class ReplaySensor final : public RodSensor {
 public:
  explicit ReplaySensor(config::record::Record record);
  Reading read(const Tick& tick) noexcept override;

 private:
  config::record::Record record_;
  const std::vector<double>* quality_;  ///< the record's own column of it, or null
  const std::vector<double>* saturated_;
  std::vector<std::int64_t> tick_;  ///< period of each row, from 0
  std::size_t next_ = 0;
};

class ReplayBackend final : public Backend {
 public:
  void visit(config::schema::Visitor& v) override { config_.visit(v); }
  [[nodiscard]] Offer open(const Opening& opening) const override;
  [[nodiscard]] bool harmless() const noexcept override { return true; }
  /// Nothing is written, so nothing moves.
  [[nodiscard]] double worst_speed_mps(const Opening&, double) const override { return 0.0; }

 private:
  ReplayConfig config_;
};

}  // namespace hal::replay
