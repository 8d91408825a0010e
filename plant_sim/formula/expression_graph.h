// Expression graph of one formula during parsing: each operation is a node with its operands. Equal
// operations share a node, constant operations are folded, small integer powers become products,
// and two operations of which the first has no other use become one (multiply_add, limit).
#pragma once

#include <cstddef>
#include <vector>

#include "plant_sim/formula/expression_program.h"
#include "plant_sim/formula/operations.h"

namespace plant_sim::formula {

class ExpressionGraph {
 public:
  /// Node handle, encoded as a negative double, because muParser passes only numbers. A
  /// non-negative number is a constant of the text.
  using Handle = double;
  static constexpr std::size_t kMostNodes = 1000;

  explicit ExpressionGraph(std::size_t parameters) : parameters_(parameters) {
    nodes_.resize(ExpressionProgram::kVariables + parameters);
  }

  [[nodiscard]] static Handle input(std::size_t index) { return handle(index); }
  Handle constant(double value);
  Handle operation(Op op, Handle a, Handle b, Handle c);
  [[nodiscard]] bool too_long() const { return nodes_.size() > kMostNodes; }

  [[nodiscard]] ExpressionProgram program(Handle result);

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
  /// Joins operations on variables in pairs; results are the same.
  void join_pairs(const std::vector<bool>& needed, const std::vector<bool>& moves);
  [[nodiscard]] std::vector<bool> needed_for(std::size_t result) const;
  [[nodiscard]] std::vector<bool> moving() const;  ///< depend on variables
  [[nodiscard]] bool fixed(std::size_t node) const { return nodes_[node].kind == Kind::constant; }

  std::size_t parameters_;
  std::vector<Node> nodes_;  ///< variables and parameters first; operands before their results
};

}  // namespace plant_sim::formula
