// A linearisation that keeps an entry once where all samples have it: most plants move fewer than
// half of the 49 entries of a transition.
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/greybox/disturbance/linearisation.h"

namespace estimator::greybox::selection {

class PackedLinearisation {
 public:
  explicit PackedLinearisation(const disturbance::Linearisation& linear);

  /// The linearisation, bit for bit.
  [[nodiscard]] disturbance::Linearisation unpacked() const;
  [[nodiscard]] std::size_t size_bytes() const;

 private:
  using Entry = std::vector<double>;  ///< one value, where all samples have it

  disturbance::Linearisation rest_;  ///< without transition and from_supply
  std::size_t samples_ = 0;
  std::vector<Entry> transition_;
  std::vector<Entry> from_supply_;
};

}  // namespace estimator::greybox::selection
