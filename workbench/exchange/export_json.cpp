#include "workbench/exchange/export_json.h"

#include <map>

#include "config/schema/error.h"
#include "workbench/exchange/mcap_writer.h"

namespace workbench::exchange {
namespace {

constexpr std::size_t kMostTopics = 10'000;

/// The JSON schema of an object like this one; what is missing in it may be a number.
Tree schema_of(const Tree& value) {
  if (value.is_boolean()) return {{"type", "boolean"}};
  if (value.is_string()) return {{"type", "string"}};
  if (value.is_number_integer()) return {{"type", "integer"}};
  if (!value.is_object()) return {{"type", "number"}};
  Tree properties = Tree::object();
  for (const auto& [key, part] : value.items()) properties[key] = schema_of(part);
  return {{"type", "object"}, {"properties", properties}};
}

}  // namespace

std::string json_lines(const std::string& input, const Kinds& kinds) {
  std::string lines;
  each_message(input, kinds, [&lines](const Message& message) {
    lines += text_of(with_timestamp(message)) + '\n';
  });
  return lines;
}

std::string mcap_file(const std::string& input, const Kinds& kinds) {
  McapWriter writer("spoolwatch");
  std::map<std::string, std::uint16_t> channels;
  each_message(input, kinds, [&](const Message& message) {
    auto channel = channels.find(message.topic);
    if (channel == channels.end()) {
      if (channels.size() == kMostTopics) {
        throw config::schema::bad_data(input, "has more than 10000 sources and alarms");
      }
      const std::uint16_t number = writer.add_channel(
          "/" + message.topic, "spoolwatch." + message.kind, text_of(schema_of(message.values)));
      channel = channels.emplace(message.topic, number).first;
    }
    writer.add(channel->second, message.t_ns, text_of(message.values));
  });
  return writer.finish();
}

}  // namespace workbench::exchange
