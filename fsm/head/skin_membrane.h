#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fsm {

/// What a photo shows at a place round an eye.
struct SkinSample {
  glm::vec2 at;      ///< on the face, millimetres
  glm::vec3 screen;  ///< 0..1
  bool above;        ///< the eye, rather than below
  float known;       ///< how surely it is skin, 0..1
  bool near;         ///< beside the lid rather than the brow
};

/// Makes samples less sure that are darker or brighter than most of the skin on their side of the
/// eye: lashes, brows, rims of glasses, reflections. `usual_above`: which part of what is near
/// above the eye is darker than skin is there, 0.5 where nothing is known.
void DoubtOddSkin(std::span<SkinSample> samples, float usual_above);

/// The mean of the skin below an eye.
glm::vec3 MeanBelow(std::span<const SkinSample> samples);

/// What would be seen where the eye is if there were none: a membrane held by the skin round it.
class SkinMembrane {
 public:
  explicit SkinMembrane(std::span<const SkinSample> samples);
  glm::vec3 At(glm::vec2 at) const;

 private:
  std::size_t Cell(int x, int y) const;

  glm::vec2 low_{};
  int width_ = 0, height_ = 0;
  std::vector<glm::vec3> colour_;
};

}  // namespace fsm
