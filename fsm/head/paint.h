#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "fsm/head/anatomy.h"
#include "fsm/head/identity.h"

namespace fsm {

struct PaintedSkin {
  glm::vec3 albedo;
  float openness;  ///< as HeadSurface::openness
};

/// Paints the skin of the base identity's face, both sides alike. Borrows its arguments.
class SkinPainter {
 public:
  SkinPainter(const Identity& identity, const EyeAnatomy& eye);
  PaintedSkin At(glm::vec3 p) const;
  /// Returns how far a shaved beard shows, 0..1: on upper lip, chin, jaw up to the front of the
  /// ear, and part of the throat. REQUIRES: at.x >= 0.
  float Beard(glm::vec2 at, float z) const;

 private:
  struct Spot {
    glm::vec2 centre, half_size;
    float blush, shade;
  };
  void AddSpots(glm::vec2 at, PaintedSkin& paint) const;
  void AddLid(glm::vec2 at, PaintedSkin& paint) const;

  const Features& features_;
  const EyeAnatomy& eye_;
  const Palette& palette_;
  std::vector<Spot> spots_;
};

}  // namespace fsm
