// The command acts later than it was given: computing, bus and converter times.
//
//   u_out(t) = u(t - delay)
//
// delay  s, up to half a second; before the run (and before a delay that is switched on during it)
//        the command was 0 V. Between two integration steps the command is taken in proportion,
//        which is the mean of the delayed command over the step.
// Source: dead time, Franklin, Powell, Workman, Digital Control of Dynamic Systems (1998).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "plant_sim/effects/site.h"
#include "plant_sim/parameter.h"
#include "plant_sim/scalar.h"

namespace plant_sim::effects {

template <class S>
struct TransportDelay {
  static constexpr const char* kName = "transport_delay";
  static constexpr const char* kEquation = "u_out = u(t - delay)";
  static constexpr std::array kSites = {Site::command};
  static constexpr bool kDissipative = false;
  static constexpr double kLongest_s = 0.5;

  struct Parameters {
    S delay_s = 0.0;

    template <class V>
    void visit(V&& v) {
      v(ParameterInfo{"delay_s", "dead time of the command", 0.0, kLongest_s, 0.01, 0.0}, delay_s);
    }
  };
  struct Memory {
    std::vector<S> past_V;
    std::size_t newest = 0;
    double step_s = 1.0;

    void prepare(double of_s) {
      step_s = of_s;
      const auto size = static_cast<std::size_t>(std::ceil(kLongest_s / of_s)) + 3;
      if (past_V.size() != size) past_V.assign(size, S(0.0));
      newest = newest < size ? newest : 0;
    }
    void reset() { std::fill(past_V.begin(), past_V.end(), S(0.0)); }
  };

  static S command_V(const Parameters& p, Memory& memory, const S& u_V) {
    const std::size_t size = memory.past_V.size();
    memory.newest = memory.newest + 1 == size ? 0 : memory.newest + 1;
    memory.past_V[memory.newest] = u_V;
    const S steps = p.delay_s * S(1.0 / memory.step_s);
    const S whole = floor(steps);
    const auto ago = [&](std::size_t count) -> const S& {
      return memory
          .past_V[memory.newest >= count ? memory.newest - count : memory.newest + size - count];
    };
    const S later_V = pick(whole, ago);
    const S earlier_V = pick(whole + S(1.0), ago);
    return later_V + (steps - whole) * (earlier_V - later_V);
  }
};

}  // namespace plant_sim::effects
