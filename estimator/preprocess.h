// Preprocessing of u and y for an estimator: removal of an offset or a trend, filtering,
// decimation.
// Off line on vectors, on line as a stream in fixed memory.
//
// u and y pass through the same linear filters, which keeps the difference equation between them.
// Decimation filters first (Butterworth, order 8, corner at 0.8 of the new Nyquist frequency) to
// avoid aliasing.
#pragma once

#include <span>
#include <vector>

#include "estimator/filter.h"

namespace estimator {

/// Subtracts the mean. NaN samples stay NaN and are not counted. Returns the mean.
double remove_mean(std::span<double> values);

struct Line {
  double offset = 0.0;  ///< at the first sample, unit of the values
  double slope = 0.0;   ///< per sample
};
/// Subtracts the least-squares straight line (offset + slope * index). Returns the line.
Line remove_line(std::span<double> values);

/// Applies the filter to the whole vector in place, from a settled start.
void apply_filter(Filter filter, std::span<double> values);

/// Every `factor`-th sample, the first included, after the anti-alias filter.
[[nodiscard]] std::vector<double> decimate(std::span<const double> values, int factor);

/// On-line preprocessing of a stream of (u, y).
struct PreprocessConfig {
  double offset_u_V = 0.0;  ///< subtracted first
  double offset_y_m = 0.0;  ///< subtracted first
  bool filter = false;      ///< apply `design` to both
  FilterDesign design;      ///< at the rate of the incoming samples
  int decimation = 1;       ///< decimation factor, at least 1
};

class Preprocess {
 public:
  /// Throws config::schema::UsageError for values out of range.
  explicit Preprocess(const PreprocessConfig& config);

  /// Takes a sample; returns true when an output is available in u_V() and y_m(). A NaN marks a
  /// missing sample: the filters restart at the next one, and the next output is NaN, so that no
  /// regression row crosses the gap. The grid of kept samples does not move.
  bool push(double u_V, double y_m) noexcept;
  /// `samples` periods without data. Returns the number of outputs in the gap.
  long long gap(long long samples) noexcept;

  [[nodiscard]] double u_V() const noexcept { return u_V_; }
  [[nodiscard]] double y_m() const noexcept { return y_m_; }
  [[nodiscard]] int decimation() const noexcept { return config_.decimation; }

 private:
  void restart() noexcept;

  PreprocessConfig config_;
  Filter filter_u_, filter_y_, alias_u_, alias_y_;
  int phase_ = 0;  // 0: the next sample is kept
  bool broken_ = false;
  double u_V_ = 0.0;
  double y_m_ = 0.0;
};

}  // namespace estimator
