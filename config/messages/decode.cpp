#include "config/messages/decode.h"

#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace config::messages {
namespace {

constexpr std::size_t kHashBytes = 8;
constexpr std::size_t kLengthBytes = 4;  // length of a string, before its text and a null byte

struct Field {
  std::string name;
  std::size_t bytes = 0;  ///< size of one element; 0: a string
  std::string count;      ///< the field that says how many there are; empty: one
};
using Fields = std::vector<Field>;

std::size_t bytes_of(const std::string& type) {
  static const std::map<std::string, std::size_t> kBytes = {
      {"int8_t", 1}, {"byte", 1},    {"boolean", 1}, {"int16_t", 2}, {"int32_t", 4},
      {"float", 4},  {"int64_t", 8}, {"double", 8},  {"string", 0}};
  return kBytes.at(type);
}

/// "name[count]" into its parts.
Field field_of(const std::string& type, const std::string& declarator) {
  const std::size_t bracket = declarator.find('[');
  Field field{declarator.substr(0, bracket), bytes_of(type), ""};
  if (bracket != std::string::npos) {
    field.count = declarator.substr(bracket + 1, declarator.find(']') - bracket - 1);
  }
  return field;
}

/// The fields of every type, from the text that lcm-gen reads.
std::map<std::string, Fields, std::less<>> declared() {
  std::map<std::string, Fields, std::less<>> types;
  std::istringstream text{std::string(declaration())};
  Fields* fields = nullptr;
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line.substr(0, line.find("//")));
    std::string type;
    std::string name;
    if (!(words >> type)) continue;
    if (type == "struct" && words >> name) {
      fields = &types[name];
    } else if (type == "}") {
      fields = nullptr;
    } else if (fields != nullptr && std::getline(words >> std::ws, name, ';')) {
      fields->push_back(field_of(type, name));
    }
  }
  return types;
}

class Walk {
 public:
  explicit Walk(std::string_view bytes) : rest_(bytes) {}

  bool skip(std::size_t bytes) {
    if (bytes > rest_.size()) return false;
    rest_.remove_prefix(bytes);
    return true;
  }
  bool skip_string() {
    const std::int64_t bytes = number();
    return bytes >= 1 && skip(kLengthBytes) && skip(static_cast<std::size_t>(bytes));
  }
  /// The four bytes ahead; -1 when there are fewer.
  [[nodiscard]] std::int64_t number() const {
    if (rest_.size() < kLengthBytes) return -1;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < kLengthBytes; ++i) {
      value = value << 8U | static_cast<unsigned char>(rest_[i]);
    }
    return static_cast<std::int32_t>(value);
  }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

}  // namespace

bool lengths_fit(std::string_view type, std::string_view bytes) {
  static const auto types = declared();
  const auto found = types.find(type);
  Walk walk(bytes);
  if (found == types.end() || !walk.skip(kHashBytes)) return false;
  std::map<std::string, std::int64_t> counts;
  for (const Field& field : found->second) {
    const std::int64_t count = field.count.empty() ? 1 : counts[field.count];
    if (count < 0 || static_cast<std::size_t>(count) > walk.left()) return false;
    if (field.bytes == 4 && field.count.empty()) counts[field.name] = walk.number();
    if (field.bytes != 0) {
      if (!walk.skip(static_cast<std::size_t>(count) * field.bytes)) return false;
      continue;
    }
    for (std::int64_t i = 0; i < count; ++i) {
      if (!walk.skip_string()) return false;
    }
  }
  return true;
}

}  // namespace config::messages
