// The operations of one formula while it is being read: each is a node that knows its operands.
// Equal operations become one node, those of constants are done at once, small whole powers are
// products.
#pragma once

#include <cstddef>
#include <vector>

#include "plant_sim/formula/tape.h"

namespace plant_sim {

class Recording {
 public:
  /// What stands for a node while muParser passes it on as a number: a negative one. A number that
  /// is not negative is a constant of the text.
  using Handle = double;
  static constexpr std::size_t kMostNodes = 1000;

  explicit Recording(std::size_t parameters) : parameters_(parameters) {
    nodes_.resize(Tape::kVariables + parameters);
  }

  [[nodiscard]] static Handle input(std::size_t index) { return handle(index); }
  Handle constant(double value);
  Handle operation(Op op, Handle a, Handle b, Handle c);
  [[nodiscard]] bool too_long() const { return nodes_.size() > kMostNodes; }

  [[nodiscard]] Tape tape(Handle result);

 private:
  enum class Kind { input, constant, operation };
  struct Node {
    Kind kind = Kind::input;
    double value = 0.0;
    Op op = Op::add;
    std::size_t a = 0, b = 0, c = 0;
  };

  static Handle handle(std::size_t node) { return -1.0 - static_cast<double>(node); }
  std::size_t node_of(Handle handle);
  std::size_t add(const Node& node);
  std::size_t power(std::size_t base, std::size_t exponent);
  std::size_t product(std::size_t base, int exponent);
  std::size_t record(Op op, std::size_t a, std::size_t b, std::size_t c);
  [[nodiscard]] bool fixed(std::size_t node) const { return nodes_[node].kind == Kind::constant; }

  std::size_t parameters_;
  std::vector<Node> nodes_;  ///< variables and parameters first; operands before their results
};

}  // namespace plant_sim
