#include "tests/truth/record.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <stdexcept>

namespace truth {
namespace {

constexpr std::size_t kPressures = 0x9e3779b9;  ///< apart from any seed in use
constexpr double kMost_V = 10.0;

/// The reference with one sample more than the record has.
std::vector<double> reference_of(const Case& of, std::size_t samples, Random& random) {
  const auto whole = static_cast<std::size_t>(std::lround(of.period_s / of.sample_s));
  // A motion's own length is what it was asked for: a chirp ends with the record.
  std::vector<double> r_m =
      reference_m(of.motion, whole > 0 ? whole : samples, random, of.sample_s);
  if (whole > 0) {
    repeat(r_m, samples + 1);
  } else {
    r_m.push_back(r_m.back());
  }
  for (double& r : r_m) r = kCentre_m + of.amplitude_ratio * (r - kCentre_m);
  return r_m;
}

class Controller {
 public:
  explicit Controller(const Case& of) : of_(of) {}

  double command_V(double r_m, double next_m, double y_m) {
    const double e_m = r_m - y_m;
    double u_V = of_.kp_V_per_m * e_m;
    if (of_.ki_V_per_m_s != 0.0) u_V += of_.ki_V_per_m_s * (sum_m_s_ + e_m * of_.sample_s);
    if (of_.kd_V_s_per_m != 0.0 && !first_) {
      u_V -= of_.kd_V_s_per_m * (y_m - before_m_) / of_.sample_s;
    }
    if (of_.feed_V_s_per_m != 0.0) u_V += of_.feed_V_s_per_m * (next_m - r_m) / of_.sample_s;
    if (std::abs(u_V) < kMost_V) sum_m_s_ += e_m * of_.sample_s;
    before_m_ = y_m;
    first_ = false;
    u_V = std::max(-kMost_V, std::min(kMost_V, u_V));
    if (of_.converter_V <= 0.0) return u_V;
    u_V = of_.converter_V * std::round(u_V / of_.converter_V);
    return std::min(u_V, kMost_V - of_.converter_V);
  }

 private:
  const Case& of_;
  double sum_m_s_ = 0.0;
  double before_m_ = 0.0;
  bool first_ = true;
};

}  // namespace

std::unique_ptr<Machine> machine(const Case& of) {
  switch (of.kind) {
    case Kind::linear_axis:
    case Kind::rotary_axis:
      return std::make_unique<Axis>(of.axis, of.hidden, of.left_out);
    case Kind::single_rod:
      return std::make_unique<Rod>(of.rod, of.hidden, of.left_out);
    case Kind::actuator:
      break;
  }
  return std::make_unique<Actuator>(of.plant, of.hidden, of.left_out);
}

Record simulate(const Case& of, int steps) {
  const auto samples = static_cast<std::size_t>(std::lround(of.length_s / of.sample_s));
  Random random(of.seed);
  const std::vector<double> r_m = reference_of(of, samples, random);
  Rig rig(machine(of), steps, of.outside, of.seed, of.sample_s);
  Case now = of;
  Controller controller(of);
  Record record;
  record.log_every = of.log_every;
  record.log_mean = of.log_mean;
  record.digits = of.kind == Kind::actuator ? 6 : 8;
  Random chance(of.seed + kPressures);  // the position's noise is the same with and without
  double sum_m2 = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    for (const Change& change : of.changes) {
      if (static_cast<std::size_t>(std::lround(change.at_s / of.sample_s)) != k) continue;
      if (change.plant != nullptr) now.plant.*change.plant = change.value;
      if (change.hidden != nullptr) now.hidden.*change.hidden = change.value;
      rig.change(machine(now));
    }
    const double reading_m = rig.reading_m();
    double y_m = reading_m + of.noise_m * random.normal();
    if (of.encoder_m > 0.0) y_m = of.encoder_m * std::round(y_m / of.encoder_m);
    const double u_V = controller.command_V(r_m[k], r_m[k + 1], y_m);
    record.t_s.push_back(static_cast<double>(k) * of.sample_s);
    record.u_V.push_back(u_V);
    record.y_m.push_back(y_m);
    record.reading_m.push_back(reading_m);
    sum_m2 += (y_m - reading_m) * (y_m - reading_m);
    if (of.pressure_noise_Pa >= 0.0) {
      record.supply_Pa.push_back(rig.inlet_Pa() + of.pressure_noise_Pa * chance.normal());
      record.in_Pa.push_back(rig.x[2] + of.pressure_noise_Pa * chance.normal());
      record.out_Pa.push_back(rig.x[3] + of.pressure_noise_Pa * chance.normal());
    }
    rig.hold(u_V);
  }
  record.floor_m = std::sqrt(sum_m2 / static_cast<double>(samples));
  record.least_Pa = rig.least_Pa;
  record.greatest_ratio = rig.greatest_ratio;
  record.fastest_mps = rig.fastest_mps;
  std::vector<double>& speeds = rig.spool_speed_mps;
  std::sort(speeds.begin(), speeds.end());
  record.quick_spool_mps = speeds[speeds.size() * 99 / 100];
  return record;
}

std::vector<double> replay(const Case& of, const std::vector<double>& u_V, int steps) {
  Rig rig(machine(of), steps, of.outside, of.seed, of.sample_s);
  std::vector<double> reading_m;
  for (const double u : u_V) {
    reading_m.push_back(rig.reading_m());
    rig.hold(u);
  }
  return reading_m;
}

namespace {

/// The command of the log's row at k, which stands for `rows` rows of the loop.
double logged_V(const Record& record, std::size_t k, std::size_t rows) {
  if (!record.log_mean) return record.u_V[k];
  const auto from = record.u_V.begin() + static_cast<std::ptrdiff_t>(k);
  rows = std::min(rows, record.u_V.size() - k);
  return std::accumulate(from, from + static_cast<std::ptrdiff_t>(rows), 0.0) /
         static_cast<double>(rows);
}

}  // namespace

void write_csv(const Record& record, const std::string& file) {
  std::FILE* out = std::fopen(file.c_str(), "w");
  if (out == nullptr) throw std::runtime_error("cannot write " + file);
  const bool pressures = !record.supply_Pa.empty();
  std::fputs("t_s,u_V,y_m", out);
  if (pressures) std::fputs(",supply_pressure_Pa,pressure_in_Pa,pressure_out_Pa", out);
  std::fputs("\n", out);
  const auto every = static_cast<std::size_t>(std::max(1, record.log_every));
  for (std::size_t k = 0; k < record.t_s.size(); k += every) {
    std::fprintf(out, "%.3f,%.6f,%.*f", record.t_s[k], logged_V(record, k, every), record.digits,
                 record.y_m[k]);
    if (pressures) {
      std::fprintf(out, ",%.1f,%.1f,%.1f", record.supply_Pa[k], record.in_Pa[k], record.out_Pa[k]);
    }
    std::fputs("\n", out);
  }
  if (std::fclose(out) != 0) throw std::runtime_error("cannot write " + file);
}

}  // namespace truth
