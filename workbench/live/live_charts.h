// Charts of the live view: motion over time, a value in its band, a value over time.
#pragma once

#include <deque>

#include "workbench/live/live_canvas.h"
#include "workbench/live/live_state.h"

namespace workbench::live {

/// A rectangle of the canvas.
struct Area {
  int row;
  int column;
  int rows;
  int columns;
};

/// Reference and position over time, newest at the right, the range written at the left.
void chart_motion(Canvas& canvas, Area area, const std::deque<MotionPoint>& points,
                  const Glyphs& glyphs);

/// The band as a bar between its limits, and the value as a marker on it.
void draw_band(Canvas& canvas, Area area, const TrackedQuantity& track, Style style,
               const Glyphs& glyphs);

/// The value over time as a sparkline, each column in the colour of its state.
void draw_history(Canvas& canvas, Area area, const TrackedQuantity& track, const Glyphs& glyphs);

}  // namespace workbench::live
