#include "face_fit/complete/light_on_face.h"

#include <glm/common.hpp>

#include "face_fit/picture/resample.h"
#include "face_fit/surface/triangles.h"
#include "fsm/rig/normals.h"

namespace facefit {

fsm::FaceLight LightOnFace(const FittedHead& fitted, const Cutout& figure) {
  const auto& position = fitted.posed_vertices;
  std::vector<std::uint32_t> corners;
  ForSkinTriangles(fitted.base->head->topology(),
                   [&](const std::uint32_t* t) { corners.insert(corners.end(), t, t + 3); });
  const auto normal = fsm::Normals(corners, position, position.size());
  constexpr float kSquarely = 0.3F, kFront = 45;  // cosine; millimetres: neither neck nor ears
  const glm::vec2 size(figure.colours.width, figure.colours.height);
  std::vector<fsm::FaceLight::Patch> patches;
  for (std::size_t v = 0; v < position.size(); ++v) {
    if (normal[v].z < kSquarely || position[v].z < kFront) continue;
    const glm::vec2 at = fitted.pose.Pixel(position[v]);
    if (at != glm::clamp(at, glm::vec2(0), size)) continue;
    patches.push_back({normal[v], ColourAt(figure.colours, at) / 255.0F});
  }
  return fsm::FaceLight(patches);
}

}  // namespace facefit
