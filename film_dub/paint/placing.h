#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

namespace filmdub {

/// An affine map of pixels.
struct Placing {
  std::array<float, 6> m{1, 0, 0, 0, 1, 0};  ///< x' = m0 x + m1 y + m2, y' = m3 x + m4 y + m5
  glm::vec2 operator()(glm::vec2 p) const {
    return {m[0] * p.x + m[1] * p.y + m[2], m[3] * p.x + m[4] * p.y + m[5]};
  }
};

/// The map by which what is drawn lies where the film shows it: least squares over the points that
/// neither speech nor lids nor brows move, and, across the face alone, over the chin. Both: the
/// network's points.
Placing PlaceOnFilm(std::span<const glm::vec2> drawn, std::span<const glm::vec2> seen);

/// Each map as a mean of those of the pictures around it, nearer ones more (a bell of
/// 1.5 pictures): what trembles is the landmarks, not the head. Where there is none stays none, and
/// what lies on its other side does not count.
std::vector<std::optional<Placing>> Smoothed(const std::vector<std::optional<Placing>>& placings);

}  // namespace filmdub
