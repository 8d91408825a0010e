// Faults at random times: the supply pressure steps or ramps to 1.25 or 0.75 of its own and back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace soak {

/// There at at_s within ramp_s, back at back_s within back_ramp_s.
struct Fault {
  double at_s;
  double ramp_s;
  double factor;
  double back_s;
  double back_ramp_s;
};

/// The first at 30 s at the earliest, the last over before duration_s. Healthy for 70 to 200 s
/// between two, so that no alarm comes often enough to be held for chattering.
std::vector<Fault> random_faults(std::uint64_t seed, double duration_s);

/// As [[sim.fault]] of a configuration.
std::string as_toml(const std::vector<Fault>& faults);

/// The configuration in the file without its [[sim.fault]] tables, and with these. Throws
/// std::runtime_error when it cannot be read.
std::string configuration(const std::filesystem::path& file, const std::vector<Fault>& faults);

}  // namespace soak
