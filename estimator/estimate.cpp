#include "estimator/estimate.h"

namespace estimator {

const char* to_string(Reason reason) noexcept {
  constexpr const char* kTexts[] = {"",
                                    "too few samples",
                                    "not excited",
                                    "coefficients not separately determined by the data",
                                    "too many samples lost at gaps",
                                    "valve command saturated",
                                    "numbers out of range"};
  return kTexts[static_cast<std::size_t>(reason)];
}

}  // namespace estimator
