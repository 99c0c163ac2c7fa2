#include "face_fit/complete/light_on_face.h"

#include <glm/common.hpp>

#include "face_fit/image/pixels.h"
#include "face_fit/image/resample.h"
#include "face_fit/surface/triangles.h"
#include "fsm/rig/normals.h"

namespace facefit {

fsm::FaceLight LightOnFace(const FittedHead& fitted, const fsm::Image& colours) {
  const auto& position = fitted.vertices;
  const auto normal =
      fsm::Normals(SkinAndLipCorners(fitted.base->surface()), position, position.size());
  constexpr float kSquarely = 0.3F;  // cosine
  constexpr float kFrontMm = 45;     // neither neck nor ears
  std::vector<fsm::FaceLight::Patch> patches;
  for (std::size_t v = 0; v < position.size(); ++v) {
    if (normal[v].z < kSquarely || position[v].z < kFrontMm) continue;
    const glm::vec2 pixel = fitted.pose.PixelOf(position[v]);
    if (!IsInside(colours, pixel)) continue;
    patches.push_back({normal[v], ColourAt(colours, pixel) / 255.0F});
  }
  return fsm::FaceLight(patches);
}

}  // namespace facefit
