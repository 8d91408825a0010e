// What a cloud of points hides: mean and RMS over equal stretches of x, as curves to lay over it.
#pragma once

#include <cstddef>
#include <vector>

#include "workbench/present/report.h"

namespace workbench::present {

struct Binned {
  Series mean{};  ///< drawn solid
  Series rms{};   ///< drawn dashed
};

/// Stretches between the least and the greatest x; those of fewer than five points are left out.
/// Missing values count nowhere. Empty when x does not vary.
[[nodiscard]] Binned binned(const std::vector<double>& x, const std::vector<double>& y,
                            std::size_t stretches = 30);

}  // namespace workbench::present
