// Reads LCM events from a pipe as they are written (config/record's reader wants a whole file).
//
// Event: sync word EDA1DA01, number (8 bytes), time stamp (8), channel's length (4), data's length
// (4), channel, data; big endian.
#pragma once

#include <fcntl.h>
#include <poll.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace soak {

class EventPipe {
 public:
  /// Waits until something has been written to it, for as long as `alive` says that it may be.
  template <class Alive>
  EventPipe(const std::filesystem::path& fifo, Alive alive) {
    const int fd = open(fifo.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    pollfd ready{fd, POLLIN, 0};
    while (fd >= 0 && poll(&ready, 1, 50) == 0 && alive()) {
    }
    if (fd < 0 || fcntl(fd, F_SETFL, O_RDONLY) != 0) {
      throw std::runtime_error("cannot read " + fifo.string());
    }
    file_ = fdopen(fd, "rb");
    std::setvbuf(file_, nullptr, _IOFBF, kBuffer);
  }
  ~EventPipe() { std::fclose(file_); }
  EventPipe(const EventPipe&) = delete;
  EventPipe& operator=(const EventPipe&) = delete;

  /// False at the end; throws std::runtime_error when it is no event.
  bool next() {
    std::array<unsigned char, 28> header{};
    if (std::fread(header.data(), header.size(), 1, file_) != 1) return false;
    if (number(&header[0]) != kSync || number(&header[20]) > kMost || number(&header[24]) > kMost) {
      throw std::runtime_error("what came is no LCM event");
    }
    channel_.resize(number(&header[20]));
    data_.resize(number(&header[24]));
    return std::fread(channel_.data(), channel_.size(), 1, file_) == 1 &&
           std::fread(data_.data(), data_.size(), 1, file_) == 1;
  }
  [[nodiscard]] const std::string& channel() const noexcept { return channel_; }
  [[nodiscard]] const std::vector<char>& data() const noexcept { return data_; }

 private:
  static constexpr std::uint32_t kSync = 0xEDA1DA01;
  static constexpr std::uint32_t kMost = 1U << 20U;
  static constexpr std::size_t kBuffer = 1U << 18U;
  static std::uint32_t number(const unsigned char* at) noexcept {
    return std::uint32_t{at[0]} << 24U | std::uint32_t{at[1]} << 16U | std::uint32_t{at[2]} << 8U |
           at[3];
  }

  std::FILE* file_ = nullptr;
  std::string channel_;
  std::vector<char> data_;
};

}  // namespace soak
