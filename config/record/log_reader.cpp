#include "config/record/log_reader.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "config/messages/dispatch.h"

namespace config::record {
namespace {

constexpr std::uint64_t kSyncWord = 0xEDA1DA01;
constexpr std::size_t kEventHeaderBytes = 28;

std::uint64_t big_endian(const unsigned char* bytes, int count) {
  std::uint64_t out = 0;
  for (int i = 0; i < count; ++i) out = out << 8 | bytes[i];
  return out;
}

}  // namespace

LogReader::LogReader(const std::string& file) : file_(file), in_(file, std::ios::binary) {
  std::error_code error;
  size_ = static_cast<std::int64_t>(std::filesystem::file_size(file, error));
  if (!in_ || error) throw schema::bad_data(file, "cannot be read");
}

const LogEvent* LogReader::next() {
  errno = 0;
  if (read_event()) return &event_;
  if (in_.bad()) {
    const std::string why = errno != 0 ? std::strerror(errno) : "read error";
    throw schema::bad_data(file_, "cannot be read (" + why + ")");
  }
  return nullptr;
}

bool LogReader::read_event() {
  std::array<unsigned char, kEventHeaderBytes> header{};
  if (!in_.read(reinterpret_cast<char*>(header.data()), kEventHeaderBytes)) return false;
  const auto channel_bytes = static_cast<std::int64_t>(big_endian(&header[20], 4));
  const auto data_bytes = static_cast<std::int64_t>(big_endian(&header[24], 4));
  const std::int64_t end =
      complete_ + static_cast<std::int64_t>(kEventHeaderBytes) + channel_bytes + data_bytes;
  if (big_endian(header.data(), 4) != kSyncWord || end > size_ || data_bytes > INT32_MAX) {
    in_.setstate(std::ios::failbit);
    return false;
  }
  event_.channel.resize(static_cast<std::size_t>(channel_bytes));
  in_.read(event_.channel.data(), channel_bytes);
  event_.data.resize(static_cast<std::size_t>(data_bytes));
  in_.read(event_.data.data(), data_bytes);
  if (!in_) return false;
  event_.number = static_cast<std::int64_t>(big_endian(&header[4], 8));
  complete_ = end;
  return true;
}

void LogReader::deliver(messages::MessageKind kind, messages::MessageHandler& handler) const {
  const auto take = [&](const auto& message) { handler.on(message); };
  if (!messages::dispatch(kind, event_.data.data(), event_.size(), take)) throw wrong_type(kind);
}

schema::DataError LogReader::wrong_type(messages::MessageKind kind) const {
  return schema::bad_data(
      where(), "on " + event_.channel + " is of another type",
      std::string("spoolwatch::") + messages::to_string(kind) + "_t in this version's layout");
}

std::string LogReader::where() const { return file_ + ": event " + std::to_string(event_.number); }

}  // namespace config::record
