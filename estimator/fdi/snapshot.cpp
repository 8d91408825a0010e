#include "estimator/fdi/snapshot.h"

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

}  // namespace estimator::fdi
