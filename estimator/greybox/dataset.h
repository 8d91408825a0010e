// Record for a comparison with a model: command and position on an even grid, in segments between
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

/// State of a sample while its segment settles. A record's first state is the model file's, from
/// which a free run starts: at rest, as far as three samples show, or during a motion. The state
/// after a gap is unknown.
enum Initialisation : char { kNotInitialising, kFromRest, kInitialisingIfObserved, kInitialising };

/// Speeds at which a plant can begin: on an axis driven by force any, beside the pressures of oil
/// or behind a velocity servo only that of the command.
enum class PlantStart { held_by_oil, any_speed };

/// Correction of a model per m of error, measured less modelled position.
struct ObserverGain {
  double position = 0.0;
  double speed_per_s = 0.0;
};

/// Gaps of the record that a data set was made from.
struct GapSummary {
  std::size_t gaps = 0;
  std::size_t segments = 0;
  std::size_t samples_left_out = 0;  ///< in segments shorter than kShortest_s
};

/// Where a channel came from; empty: unknown.
struct SourceColumn {
  std::string header;   ///< in the file, or the column's number
  std::string unit;     ///< in the file
  bool turned = false;  ///< read with the sign turned
  bool scaled = false;  ///< read with a factor that the unit does not have
};

struct Dataset {
  std::string name;
  SourceColumn command_column;
  SourceColumn position_column;
  double sample_time_s = 0.0;
  std::vector<double> t_s;
  std::vector<double> u_V;
  std::vector<double> y_m;
  std::vector<std::size_t> starts;  ///< first sample of each segment, ascending, the first is 0
  std::vector<char> valid;          ///< 0 while a segment's unknown initial state decays
  std::vector<char> initialising;   ///< Initialisation; the observer corrects the model there
  std::vector<std::string> notes;   ///< restrictions stated by the record's reader
  GapSummary gaps;
  /// The command between samples is interpolated: true to what acted well below the sample rate.
  bool command_is_interpolated = false;
  /// Where set, residuals are scaled innovations of these gains instead of the errors of a
  /// simulation with the weak observer.
  std::shared_ptr<const InnovationGains> innovations;

  [[nodiscard]] std::size_t size() const noexcept { return t_s.size(); }
  /// Share of the position error that the observer corrects at sample k.
  [[nodiscard]] double observer_gain(std::size_t k, double observer_per_s) const noexcept;
  /// See observer_correction.h.
  [[nodiscard]] ObserverGain observer_gain(std::size_t k, double observer_per_s,
                                           PlantStart start) const noexcept;
};

/// Time after a segment's start in which the error does not count.
inline constexpr double kSettling_s = 0.5;
/// Observer gain while a segment settles. A segment that begins during a motion has an unknown
/// speed and unknown pressures; the position offset they cause decays to 1e-5 in the settling time.
inline constexpr double kInitialisation_per_s = 20.0;

/// Below any rod sensor's noise; simulated records may show none at all.
inline constexpr double kLeastFloor_m = 1e-9;
/// Shorter segments are left out.
inline constexpr double kShortest_s = 1.0;

/// No sample is interpolated: each segment between gaps starts a new simulation, short segments are
/// left out. Throws config::schema::DataError when less than 2 s remain and for rates below 4 Hz.
[[nodiscard]] Dataset dataset_of(const config::record::Record& record);

/// Consecutive samples of a motion that was under way, without name.
[[nodiscard]] Dataset dataset_of(double sample_time_s, const std::vector<double>& u_V,
                                 const std::vector<double>& y_m);

/// Samples [from, to) as a data set of their own, without notes and gap summary.
[[nodiscard]] Dataset part(const Dataset& whole, std::size_t from, std::size_t to);

}  // namespace estimator::greybox
