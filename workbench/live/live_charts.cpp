#include "workbench/live/live_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "workbench/live/listen_lines.h"

namespace workbench::live {
namespace {

constexpr int kLabel = 11;             // columns for the numbers at the left
constexpr double kLeastSpan_m = 1e-3;  // least range of the motion chart

// Dots of a braille cell by [column][row from the top].
constexpr wchar_t kBraille = 0x2800;
constexpr unsigned kDot[2][4] = {{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}};

// A grid of dots, several to a cell; the style that was drawn last wins the cell.
class Dots {
 public:
  Dots(Area area, const Glyphs& glyphs)
      : area_(area),
        across_(glyphs.braille ? 2 : 1),
        down_(glyphs.braille ? 4 : 1),
        marks_(static_cast<std::size_t>(area.rows * area.columns)),
        styles_(marks_.size(), Style::normal) {}

  [[nodiscard]] int columns() const { return area_.columns * across_; }
  [[nodiscard]] int rows() const { return area_.rows * down_; }

  void set(int row, int column, Style style) {
    if (row < 0 || row >= rows() || column < 0 || column >= columns()) return;
    const auto cell = static_cast<std::size_t>(row / down_ * area_.columns + column / across_);
    marks_[cell] |= kDot[column % across_][row % down_];
    styles_[cell] = style;
  }

  void draw(Canvas& canvas, wchar_t plain) const {
    for (std::size_t i = 0; i < marks_.size(); ++i) {
      if (marks_[i] == 0) continue;
      const int row = area_.row + static_cast<int>(i) / area_.columns;
      const int column = area_.column + static_cast<int>(i) % area_.columns;
      canvas.put(
          row, column,
          across_ == 2 ? static_cast<wchar_t>(kBraille + static_cast<wchar_t>(marks_[i])) : plain,
          styles_[i]);
    }
  }

 private:
  Area area_;
  int across_;
  int down_;
  std::vector<unsigned> marks_;
  std::vector<Style> styles_;
};

struct ChartSpan {
  double low;
  double high;
  [[nodiscard]] double part(double value) const { return (value - low) / (high - low); }
};

ChartSpan motion_span(const std::deque<MotionPoint>& points) {
  ChartSpan span{HUGE_VAL, -HUGE_VAL};
  for (const MotionPoint& point : points) {
    for (const double value : {point.reference_m, point.y_m}) {
      if (std::isnan(value)) continue;
      span = {std::min(span.low, value), std::max(span.high, value)};
    }
  }
  const double lacking = kLeastSpan_m - (span.high - span.low);
  return lacking > 0.0 ? ChartSpan{span.low - lacking / 2, span.high + lacking / 2} : span;
}

// From the band's limits, or what there is of them, a quarter of the band beyond on both sides.
ChartSpan band_span(const TrackedQuantity& track) {
  const double low = std::isfinite(track.low) ? track.low : track.value;
  const double high = std::isfinite(track.high) ? track.high : track.value;
  const double width = std::max(std::abs(high - low), 1e-12 * std::abs(high) + 1e-300);
  return {low - 0.25 * width, high + 0.25 * width};
}

void right_aligned(Canvas& canvas, int row, int end, const std::string& text) {
  canvas.text(row, end - static_cast<int>(text.size()), text, Style::dim);
}

}  // namespace

void chart_motion(Canvas& canvas, Area area, const std::deque<MotionPoint>& points,
                  const Glyphs& glyphs) {
  const ChartSpan span = motion_span(points);
  if (points.empty() || !std::isfinite(span.low) || area.columns <= kLabel) return;
  for (const auto& [row, value] :
       {std::pair{area.row, span.high}, std::pair{area.row + area.rows - 1, span.low}}) {
    right_aligned(canvas, row, area.column + kLabel - 1, fmt::format("{:.2f} mm", value * 1e3));
  }
  Dots dots({area.row, area.column + kLabel, area.rows, area.columns - kLabel}, glyphs);
  const auto draw = [&](double MotionPoint::*member, Style style) {
    for (const MotionPoint& point : points) {
      if (std::isnan(point.*member)) continue;
      const double age = (points.back().t_s - point.t_s) / LiveState::kMotionSpan_s;
      const double up = span.part(point.*member);
      dots.set(static_cast<int>(std::lround((1.0 - up) * (dots.rows() - 1))),
               static_cast<int>(std::lround((1.0 - age) * (dots.columns() - 1))), style);
    }
  };
  draw(&MotionPoint::reference_m, Style::reference);
  draw(&MotionPoint::y_m, Style::position);
  dots.draw(canvas, L'*');
}

void draw_band(Canvas& canvas, Area area, const TrackedQuantity& track, Style style,
               const Glyphs& glyphs) {
  const bool has_low = std::isfinite(track.low);
  const bool has_high = std::isfinite(track.high);
  if ((!has_low && !has_high) || !std::isfinite(track.value)) return;
  const std::string low = has_low ? number_text(track.low, 4) : "";
  const std::string high = has_high ? number_text(track.high, 4) : "";
  right_aligned(canvas, area.row, area.column + kLabel - 1, low);
  const int first = area.column + kLabel;
  const int width = area.columns - 2 * kLabel;
  if (width < 8) return;
  canvas.text(area.row, first + width + 1, high, Style::dim);
  const ChartSpan span = band_span(track);
  const auto place = [&](double value) {
    const double part = std::clamp(span.part(value), 0.0, 1.0);
    return first + static_cast<int>(std::lround(part * (width - 1)));
  };
  const int low_at = has_low ? place(track.low) : first;
  const int high_at = has_high ? place(track.high) : first + width - 1;
  for (int column = first; column < first + width; ++column) {
    const bool inside = column >= low_at && column <= high_at;
    canvas.put(area.row, column, inside ? glyphs.bar : glyphs.outside,
               inside ? Style::good : Style::dim);
  }
  if (has_low) canvas.put(area.row, low_at, glyphs.edge, Style::normal);
  if (has_high) canvas.put(area.row, high_at, glyphs.edge, Style::normal);
  canvas.put(area.row, place(track.value), glyphs.marker,
             style == Style::good ? Style::bold : style);
}

void draw_history(Canvas& canvas, Area area, const TrackedQuantity& track, const Glyphs& glyphs) {
  const int width = area.columns - 2 * kLabel;
  if (width < 8 || track.history.empty()) return;
  struct Bin {
    double value = kNaN;
    bool valid = true;
  };
  std::vector<Bin> bins(static_cast<std::size_t>(width));
  ChartSpan span{std::isfinite(track.low) ? track.low : HUGE_VAL,
                 std::isfinite(track.high) ? track.high : -HUGE_VAL};
  for (const ValuePoint& point : track.history) {
    if (!std::isfinite(point.value)) continue;
    const double age = (track.history.back().t_s - point.t_s) / LiveState::kValueSpan_s;
    const auto bin = static_cast<std::size_t>(std::clamp((1.0 - age) * width, 0.0, width - 1.0));
    bins[bin] = {point.value, point.valid};
    span = {std::min(span.low, point.value), std::max(span.high, point.value)};
  }
  if (span.high <= span.low) span = {span.low - 0.5, span.high + 0.5};
  right_aligned(canvas, area.row, area.column + kLabel - 1, "history");
  const auto levels = static_cast<double>(glyphs.levels.size());
  for (int i = 0; i < width; ++i) {
    const Bin& bin = bins[static_cast<std::size_t>(i)];
    if (!std::isfinite(bin.value)) continue;
    const auto level = std::clamp(span.part(bin.value) * levels, 0.0, levels - 1.0);
    const bool outside = bin.value < track.low || bin.value > track.high;
    canvas.put(area.row, area.column + kLabel + i, glyphs.levels[static_cast<std::size_t>(level)],
               !bin.valid ? Style::invalid
               : outside  ? Style::major
                          : Style::good);
  }
}

}  // namespace workbench::live
