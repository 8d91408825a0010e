#include "daemon/io/byte_buffers.h"

#include <algorithm>
#include <cstring>

namespace monitor::io {
namespace {

using Length = std::uint32_t;

void put(std::vector<std::uint8_t>& ring, std::uint64_t position,
         std::span<const std::uint8_t> data) noexcept {
  const std::size_t at = position % ring.size();
  const std::size_t first = std::min(data.size(), ring.size() - at);
  std::copy_n(data.begin(), first, ring.begin() + static_cast<std::ptrdiff_t>(at));
  std::copy(data.begin() + static_cast<std::ptrdiff_t>(first), data.end(), ring.begin());
}

void get(const std::vector<std::uint8_t>& ring, std::uint64_t position,
         std::span<std::uint8_t> data) noexcept {
  const std::size_t at = position % ring.size();
  const std::size_t first = std::min(data.size(), ring.size() - at);
  std::copy_n(ring.begin() + static_cast<std::ptrdiff_t>(at), first, data.begin());
  std::copy_n(ring.begin(), data.size() - first, data.begin() + static_cast<std::ptrdiff_t>(first));
}

std::span<std::uint8_t, sizeof(Length)> bytes_of(Length& length) noexcept {
  return std::span<std::uint8_t, sizeof(Length)>{reinterpret_cast<std::uint8_t*>(&length),
                                                 sizeof(Length)};
}

Length length_at(const std::vector<std::uint8_t>& ring, std::uint64_t position) noexcept {
  Length length = 0;
  get(ring, position, bytes_of(length));
  return length;
}

}  // namespace

bool ByteQueue::push(std::span<const std::uint8_t> head,
                     std::span<const std::uint8_t> tail) noexcept {
  const std::uint64_t end = written_.load(std::memory_order_relaxed);
  const std::uint64_t used = end - read_.load(std::memory_order_acquire);
  const std::size_t size = sizeof(Length) + head.size() + tail.size();
  if (used + size > bytes_.size()) return false;
  auto length = static_cast<Length>(head.size() + tail.size());
  put(bytes_, end, bytes_of(length));
  put(bytes_, end + sizeof(Length), head);
  put(bytes_, end + sizeof(Length) + head.size(), tail);
  written_.store(end + size, std::memory_order_release);
  return true;
}

bool ByteQueue::pop(std::vector<std::uint8_t>& record) {
  const std::uint64_t begin = read_.load(std::memory_order_relaxed);
  if (begin == written_.load(std::memory_order_acquire)) return false;
  record.resize(length_at(bytes_, begin));
  get(bytes_, begin + sizeof(Length), record);
  read_.store(begin + sizeof(Length) + record.size(), std::memory_order_release);
  return true;
}

std::int64_t ByteBacklog::push(std::span<const std::uint8_t> record) {
  const std::size_t size = sizeof(Length) + record.size();
  if (size > bytes_.size()) return 1;
  std::int64_t lost = 0;
  for (; end_ - begin_ + size > bytes_.size(); ++lost) drop_oldest();
  auto length = static_cast<Length>(record.size());
  put(bytes_, end_, bytes_of(length));
  put(bytes_, end_ + sizeof(Length), record);
  end_ += size;
  ++records_;
  return lost;
}

std::uint64_t ByteBacklog::read(std::uint64_t position, std::vector<std::uint8_t>& record) const {
  record.resize(length_at(bytes_, position));
  get(bytes_, position + sizeof(Length), record);
  return position + sizeof(Length) + record.size();
}

void ByteBacklog::drop_oldest() {
  begin_ += sizeof(Length) + length_at(bytes_, begin_);
  --records_;
}

}  // namespace monitor::io
