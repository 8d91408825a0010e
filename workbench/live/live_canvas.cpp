#include "workbench/live/live_canvas.h"

namespace workbench::live {

Glyphs Glyphs::unicode() {
  return {.rule = L'─',
          .levels = L"▁▂▃▄▅▆▇█",
          .bar = L'━',
          .outside = L'╌',
          .edge = L'┃',
          .marker = L'◆',
          .braille = true,
          .plus_minus = L"±",
          .micro = L"µs"};
}

Glyphs Glyphs::ascii() {
  return {.rule = L'-',
          .levels = L"_.:-=+*#",
          .bar = L'=',
          .outside = L'.',
          .edge = L'|',
          .marker = L'#',
          .braille = false,
          .plus_minus = L"+-",
          .micro = L"us"};
}

Canvas::Canvas(int rows, int columns)
    : rows_(rows), columns_(columns), cells_(static_cast<std::size_t>(rows * columns)) {}

const Cell& Canvas::at(int row, int column) const {
  return cells_[static_cast<std::size_t>(row * columns_ + column)];
}

void Canvas::put(int row, int column, wchar_t glyph, Style style) {
  if (row < 0 || row >= rows_ || column < 0 || column >= columns_) return;
  cells_[static_cast<std::size_t>(row * columns_ + column)] = {glyph, style};
}

int Canvas::text(int row, int column, std::wstring_view text, Style style) {
  for (const wchar_t glyph : text) put(row, column++, glyph, style);
  return column;
}

int Canvas::text(int row, int column, std::string_view text, Style style) {
  for (const char c : text) {
    const bool printable = c >= ' ' && c <= '~';
    put(row, column++, printable ? static_cast<wchar_t>(c) : L'?', style);
  }
  return column;
}

}  // namespace workbench::live
