// A message on its way to another program's format: topic, time and a JSON tree of SI values whose
// names end in their units.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "config/messages/handler.h"

namespace workbench::exchange {

using Tree = nlohmann::ordered_json;

/// Every kind of message: "sample", "rods", "pressures", "estimate", "alarm", "health".
[[nodiscard]] const std::vector<std::string>& all_kinds();

struct Message {
  std::string kind;   ///< one of all_kinds()
  std::string topic;  ///< one curve or table each: "sample", "estimate/SOURCE", "alarm/SOURCE/NAME"
  std::int64_t t_ns = 0;  ///< UTC, or from 0 where the time is virtual or a record's
  Tree values;            ///< an object; missing numbers are null
};

[[nodiscard]] Message to_message(const spoolwatch::sample_t& sample);
/// Each rod sensor by its id, the one in charge, and which that is.
[[nodiscard]] Message to_message(const spoolwatch::rods_t& rods);
[[nodiscard]] Message to_message(const spoolwatch::pressures_t& pressures);
[[nodiscard]] Message to_message(const spoolwatch::estimate_t& estimate);
[[nodiscard]] Message to_message(const spoolwatch::alarm_t& alarm);
[[nodiscard]] Message to_message(const spoolwatch::health_t& health);

/// {"timestamp": seconds, "SOURCE": {"NAME": values}}: what PlotJuggler takes, nested by topic.
[[nodiscard]] Tree with_timestamp(const Message& message);
/// One line, whatever bytes its texts have.
[[nodiscard]] std::string text_of(const Tree& tree);

}  // namespace workbench::exchange
