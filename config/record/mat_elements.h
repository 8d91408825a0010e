// The elements that a MAT file of version 5 is made of: type, number of bytes, bytes; some of them
// packed by zlib. Either byte order.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "config/schema/error.h"

namespace config::record {

enum class MatType : std::uint32_t {
  int8 = 1,
  uint8 = 2,
  int16 = 3,
  uint16 = 4,
  int32 = 5,
  uint32 = 6,
  single = 7,
  real = 9,
  int64 = 12,
  uint64 = 13,
  matrix = 14,
  compressed = 15
};

struct MatElement {
  MatType type;
  std::string_view data;
};

[[nodiscard]] bool is_mat_version_5(std::string_view head) noexcept;

/// Reads elements one after the other, none beyond the bytes that there are.
class MatElements {
 public:
  /// After the file's header; `name` stands for the file in messages and must outlive this.
  static MatElements of_file(std::string_view content, const std::string& name);
  /// The elements inside `bytes`, which must outlive the result.
  [[nodiscard]] MatElements within(std::string_view bytes) const;

  [[nodiscard]] bool at_end() const noexcept { return rest_.empty(); }
  /// Throws schema::DataError when it does not fit into what is left.
  MatElement next();
  /// The inside of the matrix that an element of type `compressed` holds; less than it states where
  /// it states too much, as matio does of texts. `total_bytes` counts what a file unpacks to.
  [[nodiscard]] std::string unpack(const MatElement& element, std::size_t& total_bytes) const;

  /// The number at bytes[at], which must be there.
  template <class T>
  [[nodiscard]] T load(std::string_view bytes, std::size_t at) const noexcept {
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), bytes.data() + at, sizeof(T));
    if (swapped_) std::reverse(raw.begin(), raw.end());
    T value{};
    std::memcpy(&value, raw.data(), sizeof(T));
    return value;
  }
  [[nodiscard]] schema::DataError damaged(const std::string& what) const;

 private:
  MatElements(std::string_view bytes, bool swapped, bool top, const std::string& name)
      : rest_(bytes), swapped_(swapped), top_(top), name_(&name) {}

  std::string_view rest_;
  bool swapped_;  ///< the file's byte order is not this machine's
  bool top_;      ///< not inside another element: an end that is too early is a cut
  const std::string* name_;
};

}  // namespace config::record
