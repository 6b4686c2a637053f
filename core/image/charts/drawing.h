#pragma once
#include <string_view>

#include "core/base/image.h"

namespace dmise {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;

  bool operator==(const Colour&) const = default;
};

// Drawing on RGB pictures. (0, 0) is the centre of the first pixel; everything is clipped to the
// picture.

/// Returns a picture of one or three channels with three, and with `strip_rows` black rows below.
Picture to_rgb(const Picture& picture, int strip_rows = 0);

/// Draws a line one pixel wide.
void draw_line(Picture& picture, double x1, double y1, double x2, double y2, Colour colour);
void draw_circle(Picture& picture, double x, double y, double radius, Colour colour);
/// Draws a segment of width 2 `half_width` with round ends.
void draw_capsule(Picture& picture, double x1, double y1, double x2, double y2, double half_width,
                  Colour colour);

/// Draws text with its upper left corner at (x, y): 5 x 7 letters in cells of 6 x 8, times `scale`.
/// Characters without a glyph become a box.
void draw_text(Picture& picture, int x, int y, std::string_view text, Colour colour, int scale = 1);
/// Width of `text` in columns.
int text_width(std::string_view text, int scale = 1);

}  // namespace dmise
