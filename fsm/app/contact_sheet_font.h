#pragma once

#include <string_view>

#include "fsm/image/image.h"

namespace fsm {

/// Writes a line of text into a picture with our own letters, 5 x 7 points each, `scale` pixels a
/// point, 6 points apart; its left upper corner at x, y. Letters of both cases, digits and
/// . , - + % / _ : ( ); anything else is written as a box. What does not fit is cut off.
void DrawText(Image& image, int x, int y, int scale, std::string_view text);
/// Width in pixels.
int TextWidth(int scale, std::string_view text);

}  // namespace fsm
