// JSON trees cut into pieces that fit into one UDP datagram each.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "workbench/exchange/message.h"

namespace workbench::exchange {

/// No fragments on Ethernet.
inline constexpr std::size_t kMostDatagramBytes = 1400;

/// The message as one or more objects, each with the time stamp, none longer than `most_bytes`
/// (200 at least). Texts that are too long for a datagram of their own are cut.
[[nodiscard]] std::vector<std::string> datagrams_of(const Message& message,
                                                    std::size_t most_bytes = kMostDatagramBytes);

}  // namespace workbench::exchange
