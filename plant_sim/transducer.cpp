#include "plant_sim/transducer.h"

#include <limits>

#include "config/schema/error.h"

namespace plant_sim {
namespace {

/// Apart from the seeds of rod sensors, which count on from the plant's own.
constexpr std::uint64_t kSeeds = 1000;
constexpr double kMost_Pa = 1e9;

}  // namespace

void TransducerConfig::visit(config::schema::Visitor& v) {
  v.choice({"of", "measured pressure", true}, of,
           {kTransducers[0], kTransducers[1], kTransducers[2]});
  v.number({"offset_Pa", "added to the pressure"}, offset_Pa, {-kMost_Pa, kMost_Pa});
  v.number({"from_s", "start time of the offset"}, from_s,
           {0.0, std::numeric_limits<double>::infinity()});
  v.number({"noise_Pa", "standard deviation of the noise"}, noise_Pa, {0.0, kMost_Pa});
  v.number({"resolution_Pa", "resolution; 0: none"}, resolution_Pa, {0.0, kMost_Pa});
}

Transducers::Transducers(const std::vector<TransducerConfig>& configs, std::uint64_t seed) {
  for (const char* name : kTransducers) {
    TransducerConfig found;
    for (const TransducerConfig& config : configs) {
      if (config.of != name) continue;
      if (!found.of.empty()) {
        throw config::schema::bad_config("[[sim.pressure]] of",
                                         std::string("is \"") + name + "\" twice",
                                         "one entry for each pressure");
      }
      found = config;
    }
    const std::uint64_t own_seed = seed + kSeeds + all_.size();
    all_.push_back({found, Encoder(found.resolution_Pa, found.noise_Pa, own_seed)});
  }
}

double Transducers::read(std::size_t which, const config::signals::Pressures& true_Pa,
                         double t_s) noexcept {
  Transducer& own = all_[which];
  const double p_Pa = which == 0 ? true_Pa.supply_Pa : which == 1 ? true_Pa.in_Pa : true_Pa.out_Pa;
  return own.converter.read(p_Pa + (t_s >= own.config.from_s ? own.config.offset_Pa : 0.0));
}

void BenchPlant::visit(config::schema::Visitor& v) {
  v.path({"model", "model file (TOML)", true}, model, "model.toml");
  v.number({"encoder_resolution_m", "step of the encoder, 0 for none"}, encoder_resolution_m,
           {0.0, 0.1});
  v.number({"noise_m", "standard deviation of the reading"}, noise_m, {0.0, 0.1});
  v.integer({"dac_bits", "resolution of the D/A converter, 0 for none"}, dac_bits, {0, 24});
  v.number({"dac_range_V", "range of the D/A converter, both ways"}, dac_range_V, {1e-3, 1e3});
  v.integer({"seed", "seed of the noise"}, seed, {0, std::numeric_limits<std::int64_t>::max()});
  config::schema::visit_list(v, {"fault", "a scheduled change of a parameter"}, faults);
  config::schema::visit_list(v, {"pressure", "errors of a pressure transducer"}, pressures);
}

}  // namespace plant_sim
