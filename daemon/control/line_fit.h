// Incremental least-squares fit of a straight line:
//
//   y = y_mean + slope (t - t_mean)
//
// y in m, t in s, slope in m/s. Readings are relative to the first one to avoid rounding errors far
// from zero. Fixed size; no allocation.
#pragma once

#include <cmath>

namespace monitor::control {

class LineFit {
 public:
  void clear() noexcept { *this = LineFit(); }

  void add(double t_s, double y_m) noexcept {
    if (count_ == 0) {
      t0_s_ = t_s;
      y0_m_ = y_m;
    }
    const double t = t_s - t0_s_;
    const double y = y_m - y0_m_;
    ++count_;
    const double dt = t - mean_t_;
    const double dy = y - mean_y_;
    mean_t_ += dt / count_;
    mean_y_ += dy / count_;
    tt_ += dt * (t - mean_t_);
    ty_ += dt * (y - mean_y_);
    yy_ += dy * (y - mean_y_);
  }

  [[nodiscard]] int count() const noexcept { return count_; }
  /// 0 while all times are equal.
  [[nodiscard]] double slope_mps() const noexcept { return tt_ > 0.0 ? ty_ / tt_ : 0.0; }
  [[nodiscard]] double at(double t_s) const noexcept {
    return y0_m_ + mean_y_ + slope_mps() * (t_s - t0_s_ - mean_t_);
  }
  [[nodiscard]] double mean_m() const noexcept { return y0_m_ + mean_y_; }
  /// Standard deviation about the line; 0 below three readings.
  [[nodiscard]] double noise_m() const noexcept {
    if (count_ < 3) return 0.0;
    return std::sqrt(std::fmax(0.0, yy_ - slope_mps() * ty_) / (count_ - 2));
  }
  /// Time at which this line meets another; NaN for parallel lines.
  [[nodiscard]] double meets(const LineFit& other) const noexcept {
    return t0_s_ + (other.at(t0_s_) - at(t0_s_)) / (slope_mps() - other.slope_mps());
  }

 private:
  int count_ = 0;
  double t0_s_ = 0.0, y0_m_ = 0.0;
  double mean_t_ = 0.0, mean_y_ = 0.0;
  double tt_ = 0.0, ty_ = 0.0, yy_ = 0.0;
};

}  // namespace monitor::control
