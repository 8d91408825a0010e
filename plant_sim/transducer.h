// Pressure transducers on a simulated rig: what they make of the pressures that the plant has.
//
//   reading = resolution round((p + offset + noise) / resolution), offset from from_s on
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "config/signals/pressures.h"
#include "plant_sim/instruments.h"
#include "plant_sim/schedule.h"

namespace plant_sim {

/// TOML [[sim.pressure]].
struct TransducerConfig {
  std::string of;          ///< one of kTransducers
  double offset_Pa = 0.0;  ///< added from from_s on
  double from_s = 0.0;
  double noise_Pa = 0.0;       ///< standard deviation
  double resolution_Pa = 0.0;  ///< 0: none

  void visit(config::schema::Visitor& v);
};

/// In the order of Pressures; also the channels of the sim backend.
inline constexpr std::array<const char*, 3> kTransducers = {"supply_pressure", "pressure_in",
                                                            "pressure_out"};

class Transducers {
 public:
  /// Transducers without an entry have no error. Throws config::schema::ConfigError where two
  /// are of the same pressure. `seed`: of the noise.
  Transducers(const std::vector<TransducerConfig>& configs, std::uint64_t seed);

  /// The reading of one (in the order of kTransducers), with a fresh sample of its noise.
  double read(std::size_t which, const config::signals::Pressures& true_Pa, double t_s) noexcept;

 private:
  struct Transducer {
    TransducerConfig config;
    Encoder converter;  ///< its steps and noise are in Pa
  };
  std::vector<Transducer> all_;
};

/// A simulated rig as a configuration describes it: the plant's model file, the instruments between
/// it and the computer, a schedule of faults. TOML [sim] of the sim backend and of spoolwatch-rig.
struct BenchPlant {
  std::string model;
  double encoder_resolution_m = 5e-6;
  double noise_m = 0.0;
  std::int64_t dac_bits = 12;
  double dac_range_V = 10.0;
  std::int64_t seed = 1;
  std::vector<Change> faults;
  std::vector<TransducerConfig> pressures;  ///< transducers with errors

  void visit(config::schema::Visitor& v);
};

}  // namespace plant_sim
