// The live view on a terminal.
#pragma once

#include <array>

#include "workbench/live/live_canvas.h"
#include "workbench/live/live_state.h"

namespace workbench::live {

/// Draws everything into a canvas; made for 80 x 24 and any larger size.
[[nodiscard]] Canvas draw(const LiveState& state, int rows, int columns, const Glyphs& glyphs);

/// Holds the terminal from construction to destruction.
class LiveView {
 public:
  LiveView();
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  void show(const LiveState& state);
  /// True once q was pressed.
  [[nodiscard]] bool quit_asked();

 private:
  Glyphs glyphs_;
  std::array<unsigned, 10> attributes_{};  // of curses, by Style
};

}  // namespace workbench::live
