#include "estimator/filter.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "config/schema/error.h"

namespace estimator {
namespace {

using Complex = std::complex<double>;
constexpr double kPi = std::numbers::pi;

/// Analog frequency (in units where s = (z - 1) / (z + 1)) of a digital one.
double warped(double frequency_Hz, double sample_Hz) {
  return std::tan(kPi * frequency_Hz / sample_Hz);
}

/// Poles of the analog filter with non-negative imaginary part, from those of the prototype
/// 1 / prod(s - p), |p| = 1.
std::vector<Complex> analog_poles(const FilterDesign& design) {
  std::vector<Complex> out;
  for (int i = 0; i < (design.order + 1) / 2; ++i) {
    const bool real = 2 * i + 1 == design.order;
    const double angle = kPi / 2.0 + kPi * (2 * i + 1) / (2.0 * design.order);
    const Complex p = real ? Complex(-1.0, 0.0) : std::polar(1.0, angle);
    switch (design.band) {
      case Band::low_pass:
        out.push_back(p * warped(design.high_Hz, design.sample_Hz));
        break;
      case Band::high_pass:
        out.push_back(std::conj(warped(design.low_Hz, design.sample_Hz) / p));
        break;
      case Band::band_pass: {
        const double low = warped(design.low_Hz, design.sample_Hz);
        const double high = warped(design.high_Hz, design.sample_Hz);
        const Complex half = p * ((high - low) / 2.0);
        const Complex root = std::sqrt(half * half - low * high);
        // Both roots of s^2 - p B s + w0^2; the pole pair of a real prototype pole is one section.
        if (real) {
          out.push_back(half + root);
          if (std::abs((half + root).imag()) == 0.0) out.push_back(half - root);
        } else {
          out.push_back(half + root);
          out.push_back(half - root);
        }
        break;
      }
    }
  }
  return out;
}

Complex response(const Biquad& q, Complex z) {
  const Complex w = 1.0 / z;
  return (q.b0 + w * (q.b1 + w * q.b2)) / (1.0 + w * (q.a1 + w * q.a2));
}

void require(bool good, const std::string& what) {
  if (!good) throw config::schema::UsageError("filter: " + what);
}

}  // namespace

Filter::Filter(const FilterDesign& design) {
  require(design.order >= 1 && design.order <= kMaxSections,
          "order " + std::to_string(design.order) + "; allowed: 1 to 8");
  require(design.sample_Hz > 0.0 && std::isfinite(design.sample_Hz),
          "sample_Hz " + std::to_string(design.sample_Hz) + "; allowed: above 0");
  const auto corner = [&](const char* name, double value_Hz) {
    require(value_Hz > 0.0 && value_Hz < design.sample_Hz / 2.0,
            std::string(name) + " " + std::to_string(value_Hz) + "; allowed: above 0, below " +
                std::to_string(design.sample_Hz / 2.0));
  };
  if (design.band != Band::low_pass) corner("low_Hz", design.low_Hz);
  if (design.band != Band::high_pass) corner("high_Hz", design.high_Hz);
  if (design.band == Band::band_pass) {
    require(design.low_Hz < design.high_Hz, "low_Hz must be below high_Hz");
  }
  // Frequency of unit gain: DC, the Nyquist frequency, or the middle of the (warped) band.
  Complex reference(1.0, 0.0);
  Biquad zeros{1.0, 2.0, 1.0, 0.0, 0.0};
  if (design.band == Band::high_pass) {
    reference = {-1.0, 0.0};
    zeros = {1.0, -2.0, 1.0, 0.0, 0.0};
  } else if (design.band == Band::band_pass) {
    const double centre = std::atan(std::sqrt(warped(design.low_Hz, design.sample_Hz) *
                                              warped(design.high_Hz, design.sample_Hz)));
    reference = std::polar(1.0, 2.0 * centre);
    zeros = {1.0, 0.0, -1.0, 0.0, 0.0};
  }
  const std::vector<Complex> poles = analog_poles(design);
  for (std::size_t i = 0; i < poles.size(); ++i) {
    Biquad q = zeros;
    const Complex z = (1.0 + poles[i]) / (1.0 - poles[i]);
    if (poles[i].imag() != 0.0) {
      q.a1 = -2.0 * z.real();
      q.a2 = std::norm(z);
    } else if (design.band == Band::band_pass) {  // two real poles, the next one included
      const Complex other = (1.0 + poles[i + 1]) / (1.0 - poles[i + 1]);
      q.a1 = -(z.real() + other.real());
      q.a2 = z.real() * other.real();
      ++i;
    } else {  // one real pole: a first-order section
      q = {1.0, zeros.b1 / 2.0, 0.0, -z.real(), 0.0};
    }
    const double gain = 1.0 / std::abs(response(q, reference));
    q.b0 *= gain;
    q.b1 *= gain;
    q.b2 *= gain;
    biquads_[static_cast<std::size_t>(count_++)] = q;
  }
}

double Filter::push(double value) noexcept {
  if (!started_) {
    settle(value);
    started_ = true;
  }
  for (int i = 0; i < count_; ++i) {
    const Biquad& q = biquads_[static_cast<std::size_t>(i)];
    double& s1 = s1_[static_cast<std::size_t>(i)];
    double& s2 = s2_[static_cast<std::size_t>(i)];
    const double out = q.b0 * value + s1;
    s1 = q.b1 * value - q.a1 * out + s2;
    s2 = q.b2 * value - q.a2 * out;
    value = out;
  }
  return value;
}

void Filter::settle(double value) noexcept {
  for (int i = 0; i < count_; ++i) {
    const Biquad& q = biquads_[static_cast<std::size_t>(i)];
    const double out = value * (q.b0 + q.b1 + q.b2) / (1.0 + q.a1 + q.a2);
    s2_[static_cast<std::size_t>(i)] = q.b2 * value - q.a2 * out;
    s1_[static_cast<std::size_t>(i)] = out - q.b0 * value;
    value = out;
  }
}

}  // namespace estimator
