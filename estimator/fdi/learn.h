// Limits of a quantity learned from healthy estimates, for a stated mean time between false alarms.
//
// Estimates from overlapping windows are correlated, and short windows vary with the phase of the
// motion, so a quantile of all estimates taken as independent would be wrong. The record is cut
// into blocks of several windows and whole periods of the motion; the extremes of the blocks are
// close to independent. Estimates over many samples have nearly normal tails; for a normal x the
// block maxima of x^2 are close to a Gumbel distribution, which is therefore fitted to
// w = (x - c) |x - c|, c the mean:
//
//   P(max w <= z) = exp(-exp(-(z - mu)/beta)),   z(T) = mu - beta ln(-ln(1 - L/(2T)))
//
// L: block length, T: mean time between false alarms (each side gets half of the rate), mu and beta
// from the first two L-moments. The band is the upper 95 % confidence limit of z(T) for the number
// of blocks, turned back into x: up to 200 blocks from simulated fits, since few blocks tell little
// about beta; above, by the variance beta^2/n (1.113 + 0.457 y + 0.805 y^2) with y the reduced
// variate. Below 50 blocks, or five estimates in a block, the limits are at least those of a normal
// distribution known from so many windows, with the same confidence. The band keeps a distance of
// one standard error from the observed extremes.
//
// Limits: behaviour that the healthy record does not contain (drift over a day, another motion) is
// unknown; a tail heavier than normal gives more false alarms than stated; where the phase of the
// motion determines the extremes, w is nearly linear in the noise and the bands are wider than
// necessary. On-delays are ignored: they lower the rate further.
//
// Sources: J. R. M. Hosking, J. R. Wallis, Regional Frequency Analysis, 1997 (L-moments);
// H. N. Phien, Journal of Hydrology 90 (1987) 355 (variance).
#pragma once

#include <cstddef>
#include <span>

namespace estimator::fdi {

struct LearnConfig {
  double false_alarm_time_s = 86400.0;  ///< T
  double interval_s = 0.0;              ///< between two values
  double window_s = 0.0;                ///< window of each estimate
  double period_s = 0.0;                ///< period of the motion; 0: not periodic
  double least_margin = 0.0;            ///< beyond the observed extremes, unit of the values
};

struct LearnedLimits {
  double low = 0.0;
  double high = 0.0;
  double centre = 0.0;   ///< mean of the values
  double block_s = 0.0;  ///< L
  std::size_t blocks = 0;
  double widening_ratio = 1.0;  ///< margin over that of a record without end
  double enough_s = 0.0;        ///< length of healthy motion that brings widening_ratio below 1.1
};

/// `values` in time order, one per interval_s; NaN = no trustworthy estimate. Throws
/// schema::DataError when there are fewer than ten blocks.
[[nodiscard]] LearnedLimits learn_limits(std::span<const double> values, const LearnConfig& config);

/// Period of a periodic signal, from the first high peak of the autocorrelation of its first 80 s
/// (4000 samples below 50 Hz); 0 when the signal is not periodic.
[[nodiscard]] double find_period_s(std::span<const double> signal, double sample_time_s);

}  // namespace estimator::fdi
