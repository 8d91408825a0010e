#include "estimator/estimate.h"

namespace estimator {

const char* to_string(Reason reason) noexcept {
  switch (reason) {
    case Reason::none:
      return "";
    case Reason::too_short:
      return "too few samples";
    case Reason::not_excited:
      return "not excited";
    case Reason::rank_deficient:
      return "coefficients not separately determined by the data";
    case Reason::gap:
      return "too many samples lost at gaps";
    case Reason::saturated:
      return "valve command saturated";
    case Reason::not_finite:
      return "numbers out of range";
  }
  return "";
}

}  // namespace estimator
