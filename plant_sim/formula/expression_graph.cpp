#include "plant_sim/formula/expression_graph.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace plant_sim::formula {
namespace {

constexpr double kMostProducts = 8.0;  // larger powers are left to pow()

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

std::size_t operands(Op op) {
  switch (op) {
    case Op::choose:
    case Op::multiply_add:
    case Op::limit:
      return 3;
    case Op::negate:
      return 1;
    case Op::atan2:
    case Op::min:
    case Op::max:
      return 2;
    default:
      return op >= Op::abs ? 1 : 2;
  }
}

}  // namespace

std::size_t ExpressionGraph::node_of(Handle handle) {
  if (handle < 0.0) return static_cast<std::size_t>(-1.0 - handle);
  return add({Kind::constant, handle, Op::add, 0, 0, 0});
}

std::size_t ExpressionGraph::add(const Node& node) {
  for (std::size_t i = ExpressionProgram::kVariables + parameters_; i < nodes_.size(); ++i) {
    const Node& n = nodes_[i];
    const bool same = n.kind == Kind::constant
                          ? same_bits(n.value, node.value)
                          : n.op == node.op && n.a == node.a && n.b == node.b && n.c == node.c;
    if (n.kind == node.kind && same) return i;
  }
  nodes_.push_back(node);
  return nodes_.size() - 1;
}

ExpressionGraph::Handle ExpressionGraph::constant(double value) {
  return handle(add({Kind::constant, value, Op::add, 0, 0, 0}));
}

std::size_t ExpressionGraph::record(Op op, std::size_t a, std::size_t b, std::size_t c) {
  const std::size_t count = operands(op);
  if (count < 2) b = 0;
  if (count < 3) c = 0;
  if (fixed(a) && (count < 2 || fixed(b)) && (count < 3 || fixed(c))) {
    const double value = op == Op::power
                             ? std::pow(nodes_[a].value, nodes_[b].value)  // exact where it can be
                             : apply(op, nodes_[a].value, nodes_[b].value, nodes_[c].value);
    return add({Kind::constant, value, Op::add, 0, 0, 0});
  }
  if (op == Op::power && fixed(b)) return power(a, b);
  return add({Kind::operation, 0.0, op, a, b, c});
}

std::size_t ExpressionGraph::power(std::size_t base, std::size_t exponent) {
  const double n = nodes_[exponent].value;
  if (n == 0.5) return record(Op::sqrt, base, 0, 0);
  if (n != std::floor(n) || std::abs(n) > kMostProducts || n == 0.0) {
    return add({Kind::operation, 0.0, Op::power, base, exponent, 0});
  }
  const std::size_t whole = product(base, static_cast<int>(std::abs(n)));
  if (n > 0.0) return whole;
  return record(Op::divide, add({Kind::constant, 1.0, Op::add, 0, 0, 0}), whole, 0);
}

std::size_t ExpressionGraph::product(std::size_t base, int exponent) {
  if (exponent == 1) return base;
  const std::size_t half = product(base, exponent / 2);
  const std::size_t even = record(Op::multiply, half, half, 0);
  return exponent % 2 == 0 ? even : record(Op::multiply, even, base, 0);
}

ExpressionGraph::Handle ExpressionGraph::operation(Op op, Handle a, Handle b, Handle c) {
  const std::size_t first = node_of(a);
  const std::size_t second = node_of(b);
  const std::size_t third = node_of(c);
  return handle(record(op, first, second, third));
}

std::vector<bool> ExpressionGraph::needed_for(std::size_t result) const {
  std::vector<bool> needed(nodes_.size());
  needed[result] = true;
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    const Node& n = nodes_[i];
    if (!needed[i] || n.kind != Kind::operation) continue;
    const std::size_t count = operands(n.op);
    needed[n.a] = true;
    if (count > 1) needed[n.b] = true;
    if (count > 2) needed[n.c] = true;
  }
  return needed;
}

std::vector<bool> ExpressionGraph::moving() const {
  std::vector<bool> moves(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& n = nodes_[i];
    const std::size_t count = operands(n.op);
    moves[i] = n.kind == Kind::operation
                   ? moves[n.a] || (count > 1 && moves[n.b]) || (count > 2 && moves[n.c])
                   : i < ExpressionProgram::kVariables;
  }
  return moves;
}

void ExpressionGraph::join_pairs(const std::vector<bool>& needed, const std::vector<bool>& moves) {
  std::vector<std::size_t> uses(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& n = nodes_[i];
    if (!needed[i] || n.kind != Kind::operation) continue;
    const std::size_t count = operands(n.op);
    ++uses[n.a];
    if (count > 1) ++uses[n.b];
    if (count > 2) ++uses[n.c];
  }
  const auto joins = [&](std::size_t node, Op op) {
    return nodes_[node].kind == Kind::operation && nodes_[node].op == op && moves[node] &&
           uses[node] == 1;
  };
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& n = nodes_[i];
    if (!needed[i] || n.kind != Kind::operation) continue;
    const Node first = nodes_[n.a];
    const Node second = nodes_[n.b];
    if (n.op == Op::add && joins(n.b, Op::multiply)) {
      n = {Kind::operation, 0.0, Op::multiply_add, second.a, second.b, n.a};
    } else if (n.op == Op::add && joins(n.a, Op::multiply)) {
      n = {Kind::operation, 0.0, Op::multiply_add, first.a, first.b, n.b};
    } else if (n.op == Op::max && joins(n.a, Op::min)) {
      n = {Kind::operation, 0.0, Op::limit, first.a, first.b, n.b};
    }
  }
}

ExpressionProgram ExpressionGraph::program(Handle result) {
  const std::size_t end = node_of(result);
  join_pairs(needed_for(end), moving());
  const std::vector<bool> needed = needed_for(end);
  const std::vector<bool> moves = moving();

  ExpressionProgram program;
  program.parameters = parameters_;
  std::vector<std::uint16_t> place(nodes_.size());
  std::uint16_t next = 0;
  for (std::size_t i = 0; i < ExpressionProgram::kVariables + parameters_; ++i) {
    place[i] = next++;
    if (i >= ExpressionProgram::kVariables) {
      program.uses.push_back(needed[i]);
    } else if (needed[i]) {
      program.reads.push_back(place[i]);
    }
  }
  const auto each_needed = [&](Kind kind, bool moving, auto&& f) {
    for (std::size_t i = ExpressionProgram::kVariables + parameters_; i < nodes_.size(); ++i) {
      if (!needed[i] || nodes_[i].kind != kind || moves[i] != moving) continue;
      f(nodes_[i]);
      place[i] = next++;
    }
  };
  each_needed(Kind::constant, false, [&](const Node& n) { program.constants.push_back(n.value); });
  each_needed(Kind::operation, false, [&](const Node& n) {
    program.steady.push_back({n.op, place[n.a], place[n.b], place[n.c]});
  });
  each_needed(Kind::operation, true, [&](const Node& n) {
    program.moving.push_back({n.op, place[n.a], place[n.b], place[n.c]});
  });
  program.result = place[end];
  return program;
}

}  // namespace plant_sim::formula
