#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "fsm/head/anatomy.h"
#include "fsm/head/features.h"

namespace fsm {

/// Colours of a head, linear RGB.
struct Palette {
  glm::vec3 skin{0.66f, 0.425f, 0.325f};
  glm::vec3 blush{0.62f, 0.28f, 0.22f};
  glm::vec3 lip{0.48f, 0.17f, 0.155f};
  glm::vec3 hair{0.105f, 0.052f, 0.030f};
  glm::vec3 brow{0.075f, 0.042f, 0.028f};
  glm::vec3 lash{0.020f, 0.014f, 0.012f};
  glm::vec3 iris{0.20f, 0.105f, 0.045f};
  glm::vec3 cloth{0.075f, 0.13f, 0.21f};
  glm::vec3 tooth{0.76f, 0.735f, 0.66f};
  glm::vec3 lip_inside{0.40f, 0.14f, 0.125f};
  glm::vec3 rim{0.58f, 0.30f, 0.25f};
  glm::vec3 mouth{0.36f, 0.105f, 0.09f};
  glm::vec3 tongue{0.56f, 0.25f, 0.23f};
  glm::vec3 gum{0.46f, 0.18f, 0.17f};
  glm::vec3 sclera{0.74f, 0.725f, 0.71f};
  float beard = 0;  ///< how far a shaved beard shows, 0..1
};

struct PaintedSkin {
  glm::vec3 albedo;
  float open;  ///< occlusion: 1 = open to the light
};

/// Paints the skin of the base identity's face (both sides alike). What it is made of outlives it.
class SkinPainter {
 public:
  SkinPainter(const Features& features, const EyeAnatomy& eye, const Palette& palette);
  PaintedSkin At(glm::vec3 place) const;

 private:
  struct Spot {
    glm::vec2 at, size;
    float blush, shade;
  };
  void AddSpots(glm::vec2 at, PaintedSkin& paint) const;
  void AddBeard(glm::vec2 at, float z, PaintedSkin& paint) const;
  void AddLid(glm::vec2 at, PaintedSkin& paint) const;

  const Features& features_;
  const EyeAnatomy& eye_;
  const Palette& palette_;
  std::vector<Spot> spots_;
};

}  // namespace fsm
