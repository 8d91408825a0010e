// A set of augmented regression rows [psi y], reduced to its triangular factor. Two of them merge
// into the factor of all rows of both; the order of merging changes nothing but rounding.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "estimator/givens_update.h"

namespace estimator {

/// View of a factor in memory owned elsewhere (16-byte aligned, size(columns) places).
class SquareRootInformation {
 public:
  SquareRootInformation(int columns, double* memory) noexcept
      : columns_(columns), memory_(memory), absorb_(absorb_row(columns)) {}

  static constexpr std::size_t size(int columns) noexcept {
    return static_cast<std::size_t>(padded(columns)) * static_cast<std::size_t>(columns + 1);
  }

  void clear() noexcept {
    std::fill_n(memory_, size(columns_), 0.0);
    for (int i = 0; i < columns_; ++i) memory_[padded(columns_) * (i + 1) + i] = 1.0;
  }
  void copy(const SquareRootInformation& other) noexcept {
    std::copy_n(other.memory_, size(columns_), memory_);
  }
  /// `row`: the augmented row, columns() values.
  void absorb(const double* row) noexcept {
    Row copy{};
    std::copy_n(row, columns_, copy.values.data());
    absorb_(memory_, copy.values.data(), 1.0, 0);
  }
  void merge(const SquareRootInformation& other) noexcept {
    for (int i = 0; i < columns_; ++i) {
      const double weight = other.memory_[i];
      if (weight == 0.0) continue;
      Row copy;
      std::copy_n(other.memory_ + padded(columns_) * (i + 1), padded(columns_), copy.values.data());
      absorb_(memory_, copy.values.data(), weight, i);
    }
  }

  [[nodiscard]] int columns() const noexcept { return columns_; }
  /// D(i): square of the diagonal element i of the triangle.
  [[nodiscard]] double weight(int i) const noexcept { return memory_[i]; }
  /// U(i, j), j >= i.
  [[nodiscard]] double unit(int i, int j) const noexcept {
    return memory_[padded(columns_) * (i + 1) + j];
  }
  /// U beta = last column, by back substitution; false when some D(i) is zero. columns() - 1
  /// values.
  bool solve(double* value) const noexcept;

 private:
  struct Row {
    alignas(16) std::array<double, padded(kMaxColumns)> values;
  };

  int columns_;
  double* memory_;
  AbsorbRow absorb_;
};

/// Memory for one factor of any size.
struct SquareRootInformationMemory {
  alignas(16) std::array<double, SquareRootInformation::size(kMaxColumns)> values;
};

}  // namespace estimator
