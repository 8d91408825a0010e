// Decodes a message that may be damaged or hostile. The decoders that lcm-gen writes trust the
// lengths inside a message: 20 bytes there can ask for gigabytes, or end the program.
#pragma once

#include <string_view>

namespace config::messages {

/// True when every length that the message states fits into its bytes; `type` is its name in
/// spoolwatch.lcm ("estimate_t"), `bytes` start with LCM's hash.
[[nodiscard]] bool lengths_fit(std::string_view type, std::string_view bytes);

/// False when the bytes are no message of this type; `message` is then left in any state.
template <class Message>
[[nodiscard]] bool decode(Message& message, const void* data, int size) {
  return size >= 0 &&
         lengths_fit(Message::getTypeName(),
                     {static_cast<const char*>(data), static_cast<std::size_t>(size)}) &&
         message.decode(data, 0, size) >= 0;
}

/// The text of spoolwatch.lcm, as it is built into the program.
[[nodiscard]] std::string_view declaration();

}  // namespace config::messages
