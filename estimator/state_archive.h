// Serialises the state of an object to bytes and back, bit for bit: a restored object continues
// exactly as the saved one would have. Each class lists its changing members once, in
// `serialize(StateArchive&)`; the same list saves and restores. The bytes belong to this build of
// the program and to an object of the same configuration; the code that stores them must check
// both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace estimator {

class StateArchive {
 public:
  /// Appends to `bytes`, which outlives this.
  static StateArchive saving(std::vector<std::uint8_t>& bytes) noexcept {
    return StateArchive(&bytes, {});
  }
  static StateArchive restoring(std::span<const std::uint8_t> bytes) noexcept {
    return StateArchive(nullptr, bytes);
  }

  template <class T>
  void value(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    raw(&value, sizeof value);
  }
  /// A vector whose length the configuration fixes.
  template <class T>
  void fixed(std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    auto size = static_cast<std::uint64_t>(values.size());
    value(size);
    if (size != values.size()) good_ = false;
    if (good_) raw(values.data(), values.size() * sizeof(T));
  }
  /// A vector that grows to `most`.
  template <class T>
  void growing(std::vector<T>& values, std::size_t most) {
    static_assert(std::is_trivially_copyable_v<T>);
    resize(values, most);
    if (good_) raw(values.data(), values.size() * sizeof(T));
  }
  void text(std::string& text) {
    resize(text, kLongestText);
    if (good_) raw(text.data(), text.size());
  }

  [[nodiscard]] bool restores() const noexcept { return out_ == nullptr; }
  /// False when the bytes were not those of such an object, or more or fewer.
  [[nodiscard]] bool complete() const noexcept { return good_ && in_.empty(); }
  [[nodiscard]] bool good() const noexcept { return good_; }
  /// The bytes are not those of such an object.
  void fail() noexcept { good_ = false; }

 private:
  static constexpr std::size_t kLongestText = 1 << 16;

  StateArchive(std::vector<std::uint8_t>* out, std::span<const std::uint8_t> in) noexcept
      : out_(out), in_(in) {}

  template <class Container>
  void resize(Container& container, std::size_t most) {
    auto size = static_cast<std::uint64_t>(container.size());
    value(size);
    if (size > most) good_ = false;
    if (restores() && good_) container.resize(static_cast<std::size_t>(size));
  }
  void raw(void* at, std::size_t size) {
    if (size == 0) return;
    if (out_ != nullptr) {
      const auto* bytes = static_cast<const std::uint8_t*>(at);
      out_->insert(out_->end(), bytes, bytes + size);
    } else if (good_ && size <= in_.size()) {
      std::memcpy(at, in_.data(), size);
      in_ = in_.subspan(size);
    } else {
      good_ = false;
    }
  }

  std::vector<std::uint8_t>* out_;
  std::span<const std::uint8_t> in_;
  bool good_ = true;
};

}  // namespace estimator
