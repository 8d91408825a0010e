// The kinds of reference signal, one class each; equations in reference.h.
#pragma once

#include <filesystem>
#include <vector>

#include "daemon/control/reference.h"

namespace monitor::control {

class Sine final : public Reference {
 public:
  Sine(double centre_m, double amplitude_m, double frequency_Hz) noexcept;
  [[nodiscard]] double at(double t_s) const noexcept override;

 private:
  double centre_m_, amplitude_m_, frequency_Hz_;
};

class Triangle final : public Reference {
 public:
  Triangle(double centre_m, double amplitude_m, double frequency_Hz) noexcept;
  [[nodiscard]] double at(double t_s) const noexcept override;

 private:
  double centre_m_, amplitude_m_, frequency_Hz_;
};

class Multisine final : public Reference {
 public:
  Multisine(double centre_m, double amplitude_m, std::vector<double> frequencies_Hz);
  [[nodiscard]] double at(double t_s) const noexcept override;
  /// Phase in rad of the sine of that index, the first being 0.
  [[nodiscard]] double phase_rad(std::size_t index) const noexcept;

 private:
  [[nodiscard]] double sum(double t_s) const noexcept;

  double centre_m_;
  double scale_m_ = 1.0;
  std::vector<double> frequencies_Hz_;
};

class Chirp final : public Reference {
 public:
  explicit Chirp(const ReferenceConfig& config) noexcept;
  [[nodiscard]] double at(double t_s) const noexcept override;

 private:
  double centre_m_, amplitude_m_, start_Hz_, end_Hz_, sweep_s_;
};

class Steps final : public Reference {
 public:
  explicit Steps(const ReferenceConfig& config) noexcept;
  [[nodiscard]] double at(double t_s) const noexcept override;
  /// Level in m of the hold with that number; the centre before the first one.
  [[nodiscard]] double level_m(std::int64_t index) const noexcept;

 private:
  double centre_m_, amplitude_m_, hold_s_, rise_s_;
  std::uint64_t seed_;
};

class Prbs final : public Reference {
 public:
  explicit Prbs(const ReferenceConfig& config);
  [[nodiscard]] double at(double t_s) const noexcept override;

 private:
  double centre_m_, amplitude_m_, hold_s_;
  std::vector<bool> bits_;  ///< one whole period, 2^register_bits - 1
};

class FileReference final : public Reference {
 public:
  explicit FileReference(const std::filesystem::path& file);
  [[nodiscard]] double at(double t_s) const noexcept override;

 private:
  std::vector<double> t_s_, r_m_;
};

}  // namespace monitor::control
