#include "workbench/live/live_view.h"

#include <curses.h>
#include <langinfo.h>
#include <array>
#include <clocale>
#include <string_view>

namespace workbench::live {
namespace {

// The attribute of each Style, in the order of the enumeration.
std::array<unsigned, 10> attributes() {
  enum Pair : short { cyan = 1, green, yellow, red, magenta, blue };
  if (has_colors()) {
    start_color();
    use_default_colors();
    init_pair(cyan, COLOR_CYAN, -1);
    init_pair(green, COLOR_GREEN, -1);
    init_pair(yellow, COLOR_YELLOW, -1);
    init_pair(red, COLOR_RED, -1);
    init_pair(magenta, COLOR_MAGENTA, -1);
    init_pair(blue, COLOR_BLUE, -1);
  }
  const auto color = [](short pair) -> unsigned {
    return has_colors() ? static_cast<unsigned>(COLOR_PAIR(pair)) : 0U;
  };
  return {A_NORMAL,
          A_DIM,
          A_BOLD,
          A_BOLD | color(cyan),
          color(blue),
          A_BOLD | color(cyan),
          color(green),
          A_BOLD | color(yellow),
          A_BOLD | color(red),
          A_BOLD | color(magenta)};
}

}  // namespace

LiveView::LiveView() {
  std::setlocale(LC_CTYPE, "");
  const bool utf8 = std::string_view(nl_langinfo(CODESET)) == "UTF-8";
  glyphs_ = utf8 ? Glyphs::unicode() : Glyphs::ascii();
  initscr();
  cbreak();
  noecho();
  keypad(stdscr, TRUE);
  nodelay(stdscr, TRUE);
  curs_set(0);
  attributes_ = attributes();
}

LiveView::~LiveView() { endwin(); }

void LiveView::show(const LiveState& state) {
  const Canvas canvas = draw(state, LINES, COLS, glyphs_);
  erase();
  for (int row = 0; row < canvas.rows(); ++row) {
    for (int column = 0; column < canvas.columns(); ++column) {
      const Cell& cell = canvas.at(row, column);
      if (cell.glyph == L' ') continue;
      const std::array<wchar_t, 2> text{cell.glyph, L'\0'};
      attrset(static_cast<int>(attributes_[static_cast<std::size_t>(cell.style)]));
      mvaddwstr(row, column, text.data());
    }
  }
  refresh();
}

bool LiveView::quit_asked() {
  bool quit = false;
  for (int key = getch(); key != ERR; key = getch()) quit = quit || key == 'q' || key == 'Q';
  return quit;
}

}  // namespace workbench::live
