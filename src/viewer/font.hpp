#pragma once
// A bitmap font, so that pictures need no fonts of the system.

namespace bedload {

inline constexpr int kGlyphWidth = 5, kGlyphHeight = 9;

/// Whether the dot in `column` and `row` (from the top; the baseline is row 6) of a character is set.
/// Characters beyond letters, digits and a few marks are blank.
bool glyph_dot(char character, int column, int row);

}  // namespace bedload
