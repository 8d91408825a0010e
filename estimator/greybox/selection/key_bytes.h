// Keys of memos: the values that a result follows from, as bytes or as their hash.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "estimator/greybox/free_parameter.h"

namespace estimator::greybox::selection {

/// Bytes of the values that a result follows from.
class KeyBytes {
 public:
  template <class T>
  void add(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    add(std::span(&value, 1));
  }
  void add(const std::string& text) {
    add(text.size());
    bytes_ += text;
  }
  template <class T>
  void add(std::span<const T> values) {
    const std::size_t from = bytes_.size();
    bytes_.resize(from + values.size_bytes());
    if (!values.empty()) std::memcpy(bytes_.data() + from, values.data(), values.size_bytes());
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Hash after FNV-1a, of words instead of bytes; records of equal hashes are taken for equal.
class RecordHash {
 public:
  void add(double value) {
    std::uint64_t word = 0;
    std::memcpy(&word, &value, sizeof word);
    add(word);
  }
  void add(std::span<const double> values) {
    for (const double value : values) add(value);
  }
  void add(std::uint64_t word) { hash_ = (hash_ ^ word) * 0x100000001b3ULL ^ (hash_ >> 47U); }

  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

inline void add(KeyBytes& key, const std::vector<FreeParameter>& parameters) {
  key.add(parameters.size());
  for (const FreeParameter& p : parameters) {
    key.add(p.name);
    key.add(p.scale);
    for (const double value : {p.unit, p.lower, p.upper, p.prior_mean, p.prior_sd, p.origin})
      key.add(value);
    key.add(p.refinement);
    key.add(p.instead_of);
  }
}

}  // namespace estimator::greybox::selection
