#pragma once

#include <string_view>

#include "fsm/image/image.h"

namespace fsm {

/// Draws a line of text into a picture with its upper left corner at x, y, in a font of 5 x 7
/// points, `scale` pixels per point, 6 points from letter to letter. The font has letters of both
/// cases, digits and . , - + % / _ : ( ); any other character is drawn as a box. Text beyond the
/// picture is clipped.
void DrawText(Image& image, int x, int y, int scale, std::string_view text);
/// Returns the width of such a line in pixels.
int TextWidth(int scale, std::string_view text);

}  // namespace fsm
