// Goes through an LCM event log of the daemon, message by message, in the order in which they were
// told. Samples come exactly as the fault detection took them, whatever their quality.
#pragma once

#include <optional>
#include <string>

#include "config/signals/sample.h"
#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"
#include "spoolwatch/sample_t.hpp"

namespace workbench::replay {

/// What was told of a sample besides itself; null where the rig has it not.
struct Beside {
  const spoolwatch::rods_t* rods = nullptr;            ///< several rod sensors
  const spoolwatch::pressures_t* pressures = nullptr;  ///< one of them at least
};

class LogVisitor {
 public:
  virtual ~LogVisitor() = default;
  virtual void on_sample(const spoolwatch::sample_t& sample, const Beside& beside) = 0;
  virtual void on_estimate(const spoolwatch::estimate_t& /*estimate*/) {}
  virtual void on_alarm(const spoolwatch::alarm_t& /*alarm*/) {}
};

/// What was told last before a sample. A recorder that begins a new file may part a sample from it:
/// whoever walks over all files of a run keeps one for all of them.
struct Newest {
  std::optional<spoolwatch::rods_t> rods;
  std::optional<spoolwatch::pressures_t> pressures;

  [[nodiscard]] Beside beside(const spoolwatch::sample_t& sample) const noexcept;
};

/// `prefix` of the channels; a last event that is cut off is left out. Throws
/// config::schema::Error (exit 65) for a file that cannot be read or a message of another type.
void walk_log(const std::string& file, const std::string& prefix, LogVisitor& visitor,
              Newest& newest);
void walk_log(const std::string& file, const std::string& prefix, LogVisitor& visitor);

/// The prefix of the first sample's channel; "" when there is none.
[[nodiscard]] std::string find_prefix(const std::string& file);

[[nodiscard]] config::signals::Sample to_sample(const spoolwatch::sample_t& message,
                                                const Beside& beside) noexcept;

}  // namespace workbench::replay
