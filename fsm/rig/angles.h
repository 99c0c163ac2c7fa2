#pragma once

#include <array>
#include <cstddef>

namespace fsm {

/// How heads, eyes and figures are turned: degrees, counted alike on the wire, in tables, by
/// movement and in states. Positive is down, to the viewer's right, and tilted towards it.
using Angles = std::array<float, 3>;
/// The angles of an eye, which does not tilt.
using EyeAngles = std::array<float, 2>;
/// The order of the numbers.
enum Turn : std::size_t { kDown, kToRight, kTilted };

}  // namespace fsm
