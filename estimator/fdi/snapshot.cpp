#include "estimator/fdi/snapshot.h"

#include <algorithm>
#include <cstring>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "config/schema/hash.h"

namespace estimator::fdi {
namespace {

struct Head {
  char magic[8];
  std::uint64_t config;
  std::uint64_t state;
  std::int64_t tick;
  std::uint64_t size;
};
constexpr char kMagic[8] = {'S', 'W', 'S', 'T', 'A', 'T', 'E', '1'};

std::uint64_t hash_of(std::span<const std::uint8_t> bytes) noexcept {
  return config::schema::hash_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

std::string whole_text(const PipelineConfig& config, double sample_time_s) {
  PipelineConfig copy = config;
  copy.bands_file.clear();
  return config::schema::print_toml([&](config::schema::Visitor& v) {
    v.number({"sample_time_s", "sample time"}, sample_time_s);
    copy.visit(v);
  });
}

void save_snapshot(Pipeline& pipeline, std::uint64_t config, std::int64_t tick,
                   std::vector<std::uint8_t>& out) {
  out.assign(sizeof(Head), 0);
  StateArchive archive = StateArchive::saving(out);
  pipeline.serialize(archive);
  const auto state = std::span<const std::uint8_t>(out).subspan(sizeof(Head));
  Head head{{}, config, hash_of(state), tick, state.size()};
  std::memcpy(head.magic, kMagic, sizeof kMagic);
  std::memcpy(out.data(), &head, sizeof head);
}

std::int64_t load_snapshot(std::span<const std::uint8_t> bytes, std::uint64_t config,
                           Pipeline& pipeline, const std::string& where) {
  Head head{};
  if (bytes.size() >= sizeof head) std::memcpy(&head, bytes.data(), sizeof head);
  const auto state = bytes.subspan(std::min(bytes.size(), sizeof head));
  if (std::memcmp(head.magic, kMagic, sizeof kMagic) != 0 || head.size != state.size() ||
      head.state != hash_of(state)) {
    throw config::schema::bad_data(where, "is not a state of the fault detection, or is damaged");
  }
  if (head.config != config) {
    throw config::schema::bad_data(where, "is the state of another configuration");
  }
  StateArchive archive = StateArchive::restoring(state);
  pipeline.serialize(archive);
  if (!archive.complete()) {
    throw config::schema::bad_data(where, "was written by another version of the program");
  }
  return head.tick;
}

namespace {

constexpr std::size_t kMaxShown = 160;  ///< characters of a setting

/// Split at blanks, those within quotes and brackets excepted.
std::vector<std::string> split_words(std::string_view line) {
  std::vector<std::string> words(1);
  bool quoted = false;
  int depth = 0;
  for (const char c : line) {
    if (c == '\'') quoted = !quoted;
    if (!quoted && c == '[') ++depth;
    if (!quoted && c == ']') --depth;
    if (c != ' ' || quoted || depth > 0) {
      words.back() += c;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  return words;
}

/// "[table] key = value" each.
std::vector<std::string> settings_of(std::string_view line) {
  const std::vector<std::string> words = split_words(line);
  std::vector<std::string> settings;
  std::string table;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i + 2 < words.size() && words[i + 1] == "=") {
      settings.push_back(table + words[i] + " = " + words[i + 2]);
      i += 2;
    } else if (words[i].starts_with('[')) {
      table = words[i] + ' ';
    } else if (!words[i].empty()) {
      settings.push_back(words[i]);
    }
  }
  return settings;
}

std::string shown(const std::vector<std::string>& settings, std::size_t i) {
  if (i >= settings.size()) return "none";
  return settings[i].size() > kMaxShown ? settings[i].substr(0, kMaxShown) + "..." : settings[i];
}

}  // namespace

FingerprintDifference difference(std::string_view found, std::string_view expected) {
  const std::vector<std::string> one = settings_of(found);
  const std::vector<std::string> other = settings_of(expected);
  std::size_t i = 0;
  while (i < std::min(one.size(), other.size()) && one[i] == other[i]) ++i;
  return {shown(one, i), shown(other, i)};
}

}  // namespace estimator::fdi
