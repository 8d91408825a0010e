#include "daemon/control/reference.h"

#include <set>
#include "config/schema/error.h"

#include "config/schema/error.h"
#include "daemon/control/reference_kinds.h"

namespace monitor::control {

void ReferenceConfig::visit(config::schema::Visitor& v) {
  v.choice({"kind", "shape of the motion"}, kind,
           {"sine", "triangle", "multisine", "steps", "chirp", "prbs", "file"});
  if (kind == "file") {
    v.path({"file", "CSV with the columns t_s,reference_m", true}, file, "reference.csv");
    return;
  }
  v.number({"centre_m", "middle of the motion"}, centre_m, {-100.0, 100.0});
  v.number({"amplitude_m", "largest distance from the middle"}, amplitude_m, {0.0, 100.0});
  if (kind == "sine" || kind == "triangle" || kind == "chirp") {
    v.number({"frequency_Hz", "frequency; of a chirp, the first"}, frequency_Hz, {0.0, 1000.0});
  }
  if (kind == "chirp") {
    v.number({"frequency_end_Hz", "last frequency of the sweep"}, frequency_end_Hz, {0.0, 1000.0});
    v.number({"sweep_s", "duration of one sweep"}, sweep_s, {1e-3, 1e6});
  }
  if (kind == "multisine") {
    v.numbers({"frequencies_Hz", "frequencies of the sines"}, frequencies_Hz, {1e-4, 1000.0});
  }
  if (kind == "steps" || kind == "prbs") {
    v.number({"hold_s", "duration of one level"}, hold_s, {1e-3, 1e6});
    v.integer({"seed", "seed of the sequence"}, seed,
              {0, std::numeric_limits<std::int64_t>::max()});
  }
  if (kind == "steps") {
    v.number({"rise_s", "duration of the change of level, at most hold_s"}, rise_s, {0.0, hold_s});
  }
  if (kind == "prbs") {
    v.integer({"register_bits", "length of the shift register"}, register_bits, {3, 16});
  }
}

std::unique_ptr<Reference> make_reference(const ReferenceConfig& config,
                                          const std::filesystem::path& folder) {
  if (config.kind == "multisine") {
    std::set<double> different(config.frequencies_Hz.begin(), config.frequencies_Hz.end());
    if (different.empty() || different.size() < config.frequencies_Hz.size()) {
      throw config::schema::bad_config("frequencies_Hz",
                                       different.empty() ? "is empty" : "names one of them twice",
                                       "different frequencies, one at least");
    }
    return std::make_unique<Multisine>(config.centre_m, config.amplitude_m, config.frequencies_Hz);
  }
  if (config.kind == "triangle") {
    return std::make_unique<Triangle>(config.centre_m, config.amplitude_m, config.frequency_Hz);
  }
  if (config.kind == "steps") return std::make_unique<Steps>(config);
  if (config.kind == "chirp") return std::make_unique<Chirp>(config);
  if (config.kind == "prbs") return std::make_unique<Prbs>(config);
  if (config.kind == "file") return std::make_unique<FileReference>(folder / config.file);
  return std::make_unique<Sine>(config.centre_m, config.amplitude_m, config.frequency_Hz);
}

}  // namespace monitor::control
