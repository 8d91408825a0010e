// Goes through an LCM event log of the daemon, message by message, in the order in which they were
// told. Samples come exactly as the fault detection took them, whatever their quality.
#pragma once

#include <optional>
#include <string>

#include "config/messages/handler.h"
#include "config/signals/sample.h"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"

namespace workbench::replay {

/// Puts the rods and pressures that belong to a sample together with it. A recorder that begins a
/// new file may part them: one handler takes all files of a run.
class SampleHandler : public config::messages::MessageHandler {
 public:
  void on(const spoolwatch::rods_t& rods) final { rods_ = rods; }
  void on(const spoolwatch::pressures_t& pressures) final { pressures_ = pressures; }
  void on(const spoolwatch::sample_t& message) final;

 private:
  virtual void take(const config::signals::Sample& sample, const spoolwatch::sample_t& message) = 0;

  std::optional<spoolwatch::rods_t> rods_;  ///< the newest
  std::optional<spoolwatch::pressures_t> pressures_;
};

/// Messages on channels of `prefix`, health aside; a last event that is cut off is left out. Throws
/// config::schema::DataError for a file that cannot be read or a message of another type.
void walk_log(const std::string& file, const std::string& prefix,
              config::messages::MessageHandler& handler);

/// The prefix of the first sample's channel; "" when there is none.
[[nodiscard]] std::string find_prefix(const std::string& file);

}  // namespace workbench::replay
