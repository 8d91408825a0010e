// Lines of the kernel's simulated GPIO chip (gpio-sim), driven as by a rig: an encoder's A,
// B and index in quadrature, and switches. For a virtual machine with that module; as root.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace hal::hil_rig {

/// One line, pulled up or down through sysfs.
class SimLine {
 public:
  /// `chip`: "gpiochip0". Throws config::schema::Error when it is no line of a simulated chip.
  SimLine(const std::string& chip, int line);
  ~SimLine();
  SimLine(const SimLine&) = delete;
  SimLine& operator=(const SimLine&) = delete;

  /// False when the kernel rejects it.
  bool set(bool high) noexcept;

 private:
  int file_;
};

/// An encoder on two lines, or three: every quarter of a cycle is one edge, as on a real one.
class SimEncoder {
 public:
  /// `index_line` -1: none; else high in the quarter 0. Starts in quarter 0.
  SimEncoder(const std::string& chip, int line_a, int line_b, int index_line = -1);

  /// Passes every quarter on the way as fast as possible; returns the number of edges.
  std::int64_t move_to(std::int64_t quarter) noexcept;
  [[nodiscard]] std::int64_t quarter() const noexcept { return quarter_; }

 private:
  SimLine a_;
  SimLine b_;
  std::unique_ptr<SimLine> index_;
  std::int64_t quarter_ = 0;
};

}  // namespace hal::hil_rig
