// A recorded experiment as a device: position and command come from the record, nothing is written.
// The period of the loop is the record's; a period that the record lacks reads as missing. Inputs
// supply_pressure, pressure_in and pressure_out where the record has such a column.
#pragma once

#include <memory>
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

/// Position of the loop in a record.
class RecordCursor {
 public:
  explicit RecordCursor(const config::record::Record& record);
  /// Row of this period; the record's size after its end, kNone for a missing period. Ticks do not
  /// go back.
  [[nodiscard]] std::size_t at(const Tick& tick) noexcept;

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

 private:
  std::vector<std::int64_t> tick_;  ///< period of each row, from 0
  std::size_t next_ = 0;
};

class ReplaySensor final : public RodSensor {
 public:
  explicit ReplaySensor(std::shared_ptr<const config::record::Record> record);
  explicit ReplaySensor(const config::record::Record& record)
      : ReplaySensor(std::make_shared<const config::record::Record>(record)) {}
  Reading read(const Tick& tick) noexcept override;

 private:
  std::shared_ptr<const config::record::Record> record_;
  const std::vector<double>* quality_;  ///< quality column of the record, or null
  const std::vector<double>* saturated_;
  RecordCursor rows_;
};

/// A column of the record.
class ReplayInput final : public Input {
 public:
  /// `column` belongs to the record.
  ReplayInput(std::shared_ptr<const config::record::Record> record,
              const std::vector<double>& column);
  InputReading read(const Tick& tick) noexcept override;

 private:
  std::shared_ptr<const config::record::Record> record_;
  const std::vector<double>& column_;
  RecordCursor rows_;
};

class ReplayBackend final : public Backend {
 public:
  void visit(config::schema::Visitor& v) override { config_.visit(v); }
  [[nodiscard]] BackendDevices open(const OpenContext& context) const override;
  [[nodiscard]] bool harmless() const noexcept override { return true; }
  /// True: nothing is written, so nothing moves.
  [[nodiscard]] double worst_speed_mps(const OpenContext&, double) const override { return 0.0; }

 private:
  ReplayConfig config_;
};

}  // namespace hal::replay
