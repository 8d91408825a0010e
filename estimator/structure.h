// Past samples that a linear difference equation uses.
//
//   y(t) + a1 y(t-1) + ... + an y(t-n) = b1 u(t-k) + ... + bm u(t-k-m+1) [+ c] + e(t)
//
// y: output (m), u: input (V), n, m: orders, k: delay in samples, c: optional constant (m).
// "ARX211" is n = 2, m = 1, k = 1. Source: Song 2002, chapter 2; L. Ljung, System Identification.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace estimator {

inline constexpr int kMaxOrder = 10;
inline constexpr int kMaxDelay = 50;
inline constexpr int kMaxCoefficients = kMaxOrder + kMaxOrder + 1;

struct Structure {
  int n = 1;              ///< past outputs, 0 to kMaxOrder
  int m = 1;              ///< past inputs, 0 to kMaxOrder, n + m at least 1
  int k = 1;              ///< delay in samples, 0 to kMaxDelay
  bool constant = false;  ///< a constant term, the last coefficient

  /// Number of coefficients, in the order a1..an, b1..bm, constant.
  [[nodiscard]] constexpr int size() const noexcept { return n + m + (constant ? 1 : 0); }
  /// Samples before the first that can be a target.
  [[nodiscard]] constexpr int history() const noexcept {
    const int input = m > 0 ? k + m - 1 : 0;
    return n > input ? n : input;
  }
  /// "a1".."an", "b1".."bm", "constant".
  [[nodiscard]] std::vector<std::string> names() const;
  /// "arx211", or "arx(10,2,1)" when an order has two digits; the constant is not shown.
  [[nodiscard]] std::string text() const;

  friend bool operator==(const Structure&, const Structure&) = default;
};

/// Reads "arx211", "ARX211" or "arx(10,2,1)". Throws config::schema::UsageError otherwise.
[[nodiscard]] Structure parse_structure(std::string_view text, bool constant = false);

}  // namespace estimator
