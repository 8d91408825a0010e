// A rectangle of styled characters: what the live view draws on, with or without a terminal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace workbench::live {

enum class Style { normal, dim, bold, title, reference, position, good, minor, major, invalid };

struct Cell {
  wchar_t glyph = L' ';
  Style style = Style::normal;
};

/// The characters of the view; `ascii` for a terminal without UTF-8.
struct Glyphs {
  wchar_t rule;
  std::wstring levels;  // of a sparkline, lowest first
  wchar_t bar;          // inside the band
  wchar_t outside;      // outside the band
  wchar_t edge;         // of the band
  wchar_t marker;
  bool braille;  // charts of 2 x 4 dots a cell, else one mark a cell
  std::wstring plus_minus;
  std::wstring micro;

  static Glyphs unicode();
  static Glyphs ascii();
};

class Canvas {
 public:
  Canvas(int rows, int columns);

  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] const Cell& at(int row, int column) const;
  /// Outside of the rectangle nothing happens.
  void put(int row, int column, wchar_t glyph, Style style);
  /// Returns the column after the text.
  int text(int row, int column, std::wstring_view text, Style style = Style::normal);
  int text(int row, int column, std::string_view text, Style style = Style::normal);

 private:
  int rows_;
  int columns_;
  std::vector<Cell> cells_;
};

}  // namespace workbench::live
