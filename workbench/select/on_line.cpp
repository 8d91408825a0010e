// Where a sound recursive form exists, and where none does.
//
// ARX: least squares, exact. ARMAX: recursive maximum likelihood and extended least squares.
// Output error, Box-Jenkins: recursive prediction error, if F keeps inside the unit circle; its
// prediction never looks at y, so behind an integrating rod it drifts away with any offset of the
// input. State space: recursive subspace methods track a basis that turns as they go, at the price
// of a decomposition a sample; ARMAX of the same order follows the same transfer functions.
// Network: its weights are not determined one by one; recursive gradients have no proof.
#include <algorithm>

#include "workbench/select/outcome.h"

namespace workbench::select {
namespace {

constexpr double kMostPole = 0.999;  // of F: the recursive filter's own limit
constexpr const char* kIntegrates =
    "its poles reach the unit circle: the prediction, never corrected by y, would diverge";

}  // namespace

OnLine on_line_form(const StructureCandidate& candidate, const Fitted& fitted) {
  OnLine out;
  out.method = "none";
  if (std::holds_alternative<structures::SubspaceOptions>(candidate.what)) {
    out.why =
        "recursive subspace methods change their state basis over time; ARMAX represents the same "
        "transfer functions";
    return out;
  }
  if (std::holds_alternative<structures::NarxOptions>(candidate.what)) {
    out.why = "its weights are not determined individually, and no recursion is proven to converge";
    return out;
  }
  const structures::Orders& o = std::get<structures::Orders>(candidate.what);
  if (o.f > 0) {
    const auto* model = std::get_if<structures::Polynomial>(&fitted.model);
    if (!fitted.valid || model == nullptr || structures::largest_root(model->f) > kMostPole) {
      out.why = kIntegrates;
      return out;
    }
    out.method = "RPEM";
  } else {
    out.method = o.c > 0 ? "RML" : "RLS";
  }
  out.sound = true;
  return out;
}

}  // namespace workbench::select
