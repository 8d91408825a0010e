#include "config/record/event_reader.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <vector>

#include "config/schema/error.h"

namespace config::record {
namespace {

constexpr std::uint64_t kSyncWord = 0xEDA1DA01;
constexpr std::size_t kHeaderBytes = 28;

std::uint64_t big_endian(const unsigned char* bytes, int count) {
  std::uint64_t out = 0;
  for (int i = 0; i < count; ++i) out = out << 8 | bytes[i];
  return out;
}

}  // namespace

struct EventReader::State {
  std::ifstream in;
  std::int64_t size = 0;
  std::int64_t complete = 0;
  std::vector<char> data;
  lcm::LogEvent event{};
};

EventReader::EventReader(const std::string& file) : state_(std::make_unique<State>()) {
  std::error_code error;
  state_->in.open(file, std::ios::binary);
  state_->size = static_cast<std::int64_t>(std::filesystem::file_size(file, error));
  if (!state_->in || error) throw schema::bad_data(file, "cannot be read");
}
EventReader::~EventReader() = default;

const lcm::LogEvent* EventReader::next() {
  State& s = *state_;
  std::array<unsigned char, kHeaderBytes> header{};
  if (!s.in.read(reinterpret_cast<char*>(header.data()), kHeaderBytes)) return nullptr;
  const auto channel_bytes = static_cast<std::int64_t>(big_endian(&header[20], 4));
  const auto data_bytes = static_cast<std::int64_t>(big_endian(&header[24], 4));
  const std::int64_t end =
      s.complete + static_cast<std::int64_t>(kHeaderBytes) + channel_bytes + data_bytes;
  if (big_endian(header.data(), 4) != kSyncWord || end > s.size || data_bytes > INT32_MAX) {
    s.in.setstate(std::ios::failbit);
    return nullptr;
  }
  s.event.channel.resize(static_cast<std::size_t>(channel_bytes));
  s.in.read(s.event.channel.data(), channel_bytes);
  s.data.resize(static_cast<std::size_t>(data_bytes));
  s.in.read(s.data.data(), data_bytes);
  if (!s.in) return nullptr;
  s.event.eventnum = static_cast<std::int64_t>(big_endian(&header[4], 8));
  s.event.timestamp = static_cast<std::int64_t>(big_endian(&header[12], 8));
  s.event.datalen = static_cast<std::int32_t>(data_bytes);
  s.event.data = s.data.data();
  s.complete = end;
  return &s.event;
}

std::int64_t EventReader::complete() const noexcept { return state_->complete; }
bool EventReader::at_end() const noexcept { return state_->complete >= state_->size; }

}  // namespace config::record
