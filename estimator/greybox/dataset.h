// A record as a model is held against it: command and position on an even grid, in segments between
// which samples are missing.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace config::record {
struct Record;
}

namespace estimator::greybox {

struct InnovationGains;

/// Of a sample while its segment settles. A record's very first state is the model file's: pure
/// simulation begins there; a state behind a gap nobody knows.
enum Initialisation : char { kNotInitialising, kInitialisingIfObserved, kInitialising };

struct Dataset {
  std::string name;
  double sample_time_s = 0.0;
  std::vector<double> t_s;
  std::vector<double> u_V;
  std::vector<double> y_m;
  std::vector<std::size_t> starts;  ///< first sample of each segment, ascending, the first is 0
  std::vector<char> valid;          ///< 0 while a segment's unknown initial state dies away
  std::vector<char> initialising;   ///< where that state is a motion: the model is led, see Led
  std::vector<std::string> notes;   ///< restrictions that a reader of results should know
  /// Where set, residuals are scaled innovations of these gains instead of the errors of a
  /// simulation with the weak observer.
  std::shared_ptr<const InnovationGains> innovations;

  [[nodiscard]] std::size_t size() const noexcept { return t_s.size(); }
  /// By which share of its error the model's position is set right at sample k.
  [[nodiscard]] double observer_gain(std::size_t k, double observer_per_s) const noexcept;
};

/// How long after a segment's start the error does not count.
inline constexpr double kSettling_s = 0.5;
/// A segment that begins in the midst of a motion begins with a speed and pressures that the model
/// does not know. While it settles, the model's position is led to the measured one at this rate:
/// what the unknown state shifted is gone then, down to a hundred-thousandth.
inline constexpr double kInitialisation_per_s = 20.0;

/// Better than any rod's sensor; simulated ones may show no noise at all.
inline constexpr double kLeastFloor_m = 1e-9;
/// Segments shorter than this are left out.
inline constexpr double kShortest_s = 1.0;

/// Throws config::schema::DataError when what remains is shorter than 2 s,
/// and for rates below 4 Hz. No sample is
/// invented: segments between gaps start anew, short ones are left out and noted.
[[nodiscard]] Dataset dataset_of(const config::record::Record& record);

/// Samples [from, to) as a record of their own.
[[nodiscard]] Dataset part(const Dataset& whole, std::size_t from, std::size_t to);

}  // namespace estimator::greybox
