#include "tests/truth/motion.h"

#include <cmath>
#include <functional>
#include <stdexcept>

namespace truth {
namespace {

constexpr double kTwoPi = 6.283185307179586;

std::vector<double> sampled(std::size_t samples, double sample_s,
                            const std::function<double(double)>& at) {
  std::vector<double> r_m(samples);
  for (std::size_t k = 0; k < samples; ++k) {
    r_m[k] = kCentre_m + at(static_cast<double>(k) * sample_s);
  }
  return r_m;
}

std::vector<double> multisine(std::size_t samples, double sample_s, Random& random) {
  std::vector<double> f_Hz;
  std::vector<double> phase_rad;
  for (int i = 0; i < 10; ++i) {
    f_Hz.push_back(0.1 * std::pow(1.45, i));
    phase_rad.push_back(random.uniform(0.0, kTwoPi));
  }
  return sampled(samples, sample_s, [&](double t_s) {
    double sum_m = 0.0;
    for (std::size_t i = 0; i < f_Hz.size(); ++i) {
      sum_m += 0.0127 / (1.0 + f_Hz[i]) * std::sin(kTwoPi * f_Hz[i] * t_s + phase_rad[i]);
    }
    return sum_m;
  });
}

std::vector<double> steps(std::size_t samples, double sample_s, double most_m, double hold_s,
                          double lag_s, Random& random) {
  const auto held = static_cast<std::size_t>(std::lround(hold_s / sample_s));
  const double keep = std::exp(-sample_s / lag_s);
  double level_m = 0.0;
  double first_m = 0.0;
  double second_m = 0.0;
  std::vector<double> r_m(samples);
  for (std::size_t k = 0; k < samples; ++k) {
    if (k % held == 0) level_m = random.uniform(-most_m, most_m);
    r_m[k] = kCentre_m + second_m;
    first_m = level_m + keep * (first_m - level_m);
    second_m = first_m + keep * (second_m - first_m);
  }
  return r_m;
}

std::vector<double> triangle(std::size_t samples, double sample_s, Random& random) {
  const double amplitude_m = random.uniform(0.020, 0.035);
  const double f_Hz = random.uniform(0.2, 0.4);
  return sampled(samples, sample_s, [&](double t_s) {
    const double turn = t_s * f_Hz + 0.25;
    return amplitude_m * (1.0 - 4.0 * std::abs(turn - std::floor(turn) - 0.5));
  });
}

std::vector<double> chirp(std::size_t samples, double sample_s) {
  const double length_s = static_cast<double>(samples) * sample_s;
  const double growth = std::log(25.0);
  return sampled(samples, sample_s, [&](double t_s) {
    const double f_Hz = 0.1 * std::exp(growth * t_s / length_s);
    return 0.030 / (1.0 + f_Hz) * std::sin(kTwoPi * length_s / growth * (f_Hz - 0.1));
  });
}

}  // namespace

double Random::uniform(double low, double high) {
  return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
}

double Random::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0.0, 1.0)));
  return radius * std::cos(uniform(0.0, kTwoPi));
}

double Random::around(double typical, double factor) {
  return typical * std::pow(factor, uniform(-1.0, 1.0));
}

std::size_t Random::below(std::size_t count) { return engine_() % count; }

const std::vector<std::string>& motions() {
  static const std::vector<std::string> names{"multisine", "fast_steps", "slow_steps",
                                              "sine",      "triangle",   "chirp"};
  return names;
}

void repeat(std::vector<double>& period_m, std::size_t samples) {
  const std::size_t whole = period_m.size();
  // The sample behind the last one lies as far on as the last two are apart.
  const double end_m = whole > 1 ? 2.0 * period_m[whole - 1] - period_m[whole - 2] : period_m[0];
  const double gap_m = end_m - period_m[0];
  for (std::size_t k = 0; k < whole; ++k) {
    period_m[k] -= gap_m * (static_cast<double>(k) / static_cast<double>(whole) - 0.5);
  }
  period_m.resize(samples);
  for (std::size_t k = whole; k < samples; ++k) period_m[k] = period_m[k - whole];
}

std::vector<double> reference_m(const std::string& motion, std::size_t samples, Random& random,
                                double sample_s) {
  if (motion == "multisine") return multisine(samples, sample_s, random);
  if (motion == "fast_steps") return steps(samples, sample_s, 0.045, 0.35, 0.11, random);
  if (motion == "slow_steps") return steps(samples, sample_s, 0.050, 1.5, 0.04, random);
  if (motion == "triangle") return triangle(samples, sample_s, random);
  if (motion == "chirp") return chirp(samples, sample_s);
  if (motion == "sine") {
    return sampled(samples, sample_s,
                   [](double t_s) { return 0.0254 * std::sin(kTwoPi * 0.5 * t_s); });
  }
  throw std::invalid_argument("no motion '" + motion +
                              "'; there are multisine, fast_steps, slow_steps, sine, triangle, "
                              "chirp");
}

}  // namespace truth
