#pragma once

#include <array>
#include <cstddef>

namespace fsm {

/// Rotation angles of heads, eyes and figures in degrees, signed alike on the wire, in tables, in
/// motion and in states: positive is down, to the viewer's right, and tilted that way.
using Angles = std::array<float, 3>;
/// Rotation angles of an eye, which does not tilt.
using EyeAngles = std::array<float, 2>;
/// Indices into Angles and EyeAngles.
enum Axis : std::size_t { kDown, kToRight, kTilted };

}  // namespace fsm
