#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fsm {

/// What a photo shows at a place near an eye.
struct SkinSample {
  glm::vec2 position;  ///< on the face, millimetres
  glm::vec3 screen;    ///< 0..1
  bool above;          ///< above the eye rather than below
  float confidence;    ///< that it is skin, 0..1
  bool beside_lid;     ///< close to the lid rather than to the brow
};

/// Lowers the confidence of samples that are darker or brighter than most skin on their side of the
/// eye: lashes, brows, rims of glasses, reflections. `usual_above`: the quantile of brightness that
/// counts as skin near the eye above it; 0.5 if nothing is known.
void DownweightOutliers(std::span<SkinSample> samples, float usual_above);

/// Returns the mean screen colour of the skin below an eye.
glm::vec3 MeanBelow(std::span<const SkinSample> samples);

/// The skin that would be visible without the eye: a membrane held by the skin around the eye.
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
