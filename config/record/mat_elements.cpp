#include "config/record/mat_elements.h"

#include <zlib.h>

#include <algorithm>
#include <bit>

namespace config::record {
namespace {

constexpr std::size_t kHeaderBytes = 128;
constexpr std::size_t kVersionAt = 124;
constexpr std::size_t kTagBytes = 8;
/// Limits of the unpacked size of a file: a small one, or one that measured data can be packed to,
/// and never more than kMostBytes. zlib itself packs no better than kBestRatio.
constexpr std::size_t kMostBytes = std::size_t{1} << 30U;
constexpr std::size_t kSmallBytes = std::size_t{1} << 26U;
constexpr std::size_t kUsualRatio = 100;
constexpr std::size_t kBestRatio = 1032;

class Inflater {
 public:
  explicit Inflater(std::string_view packed) {
    // zlib's interface is not const-correct: it only reads from here.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream_.avail_in = static_cast<uInt>(packed.size());
    ready_ = inflateInit(&stream_) == Z_OK;
  }
  ~Inflater() {
    if (ready_) inflateEnd(&stream_);
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// Up to `most` bytes more; empty for bytes that zlib did not pack.
  std::string next(std::size_t most) {
    std::string out(most, '\0');
    stream_.next_out = reinterpret_cast<Bytef*>(out.data());
    stream_.avail_out = static_cast<uInt>(out.size());
    const int result = ready_ ? inflate(&stream_, Z_SYNC_FLUSH) : Z_MEM_ERROR;
    const bool good = result == Z_OK || result == Z_STREAM_END || result == Z_BUF_ERROR;
    out.resize(good ? out.size() - stream_.avail_out : 0);
    ended_ = result == Z_STREAM_END;
    return out;
  }
  /// True when the stream ends here with the check sum of all that came.
  bool ends() {
    if (!ended_ && !next(1).empty()) return false;
    return ended_;
  }

 private:
  z_stream stream_{};
  bool ready_ = false;
  bool ended_ = false;
};

}  // namespace

bool is_mat_version_5(std::string_view head) noexcept {
  if (head.size() < kHeaderBytes) return false;
  const std::string_view version = head.substr(kVersionAt, 4);
  return version == std::string_view("\x00\x01IM", 4) ||
         version == std::string_view("\x01\x00MI", 4);
}

MatElements MatElements::of_file(std::string_view content, const std::string& name) {
  const bool little = content.substr(kVersionAt + 2, 2) == "IM";
  return {content.substr(kHeaderBytes), little != (std::endian::native == std::endian::little),
          true, name};
}

MatElements MatElements::within(std::string_view bytes) const {
  return {bytes, swapped_, false, *name_};
}

schema::DataError MatElements::damaged(const std::string& what) const {
  return schema::bad_data(*name_, "is damaged: a variable's " + what + " make no sense",
                          "a MAT file of version 5 to 7");
}

MatElement MatElements::next() {
  const auto cut = [this] {
    return top_ ? schema::bad_data(*name_, "is cut off within a variable") : damaged("parts");
  };
  if (rest_.size() < kTagBytes) throw cut();
  const auto first = load<std::uint32_t>(rest_, 0);
  MatElement element{static_cast<MatType>(first & 0xFFFFU), {}};
  std::size_t used = kTagBytes;
  if (const std::size_t small = first >> 16U; small != 0) {
    if (small > 4) throw damaged("parts");
    element.data = rest_.substr(4, small);
  } else {
    const std::size_t bytes = load<std::uint32_t>(rest_, 4);
    if (bytes > rest_.size() - kTagBytes) throw cut();
    element.data = rest_.substr(kTagBytes, bytes);
    used += bytes;
    if (element.type != MatType::compressed) used += (kTagBytes - bytes % kTagBytes) % kTagBytes;
  }
  rest_.remove_prefix(std::min(used, rest_.size()));
  return element;
}

std::string MatElements::unpack(const MatElement& element, std::size_t& total_bytes) const {
  Inflater inflater(element.data);
  const std::string tag = inflater.next(kTagBytes);
  if (tag.size() < kTagBytes ||
      load<std::uint32_t>(tag, 0) != static_cast<unsigned>(MatType::matrix)) {
    throw damaged("packed bytes");
  }
  const std::size_t bytes = load<std::uint32_t>(tag, 4);
  if (bytes > (element.data.size() + 1) * kBestRatio) throw damaged("packed bytes");
  total_bytes += bytes;
  if (total_bytes > std::min(kMostBytes, kSmallBytes + element.data.size() * kUsualRatio)) {
    throw schema::bad_data(
        *name_,
        "unpacks to more than " + std::to_string(kUsualRatio) + " times its size and 64 MiB",
        "measured data; a file saved without compression");
  }
  std::string unpacked = inflater.next(bytes);
  if (unpacked.size() != bytes || !inflater.ends()) throw damaged("packed bytes");
  return unpacked;
}

}  // namespace config::record
