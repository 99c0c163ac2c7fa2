#include "face_fit/complete/bust.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "face_fit/image/filters.h"
#include "face_fit/surface/visible_surface.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Draws the bust as `pose` shows it, one sample for each pixel of an image of that size.
Bust DrawWith(const FittedHead& fitted, CameraPose pose, int width, int height) {
  const ObservedHead& base = *fitted.base;
  // The bust stands upright; it is lowered where the fitted head's chin lies lower than the
  // built-in one's.
  pose.rotation_rad = {};
  const float chin_y_mm = base.AtRest(point::kChin).y;
  const glm::vec3 lower(0, chin_y_mm - fitted.PositionOf(point::kChin).y, 0);
  const float highest = chin_y_mm + PhotoLook().bust.above_chin_mm;
  const fsm::HeadSurface& mesh = base.surface();
  std::vector<glm::vec3> positions = base.rest().position;
  for (glm::vec3& p : positions) p -= lower;
  VisibleSurface surface({glm::vec2(0.5F), 1, width, height}, pose.ToScreen(positions));
  const auto body = [](fsm::Material m) {
    return m == fsm::Material::kCloth || m == fsm::Material::kSkin;
  };
  ForEachTriangle(mesh, body, [&](const MeshTriangle& triangle) {
    const bool above = std::ranges::any_of(
        triangle.corner, [&](std::uint32_t v) { return base.rest().position[v].y > highest; });
    if (!above) surface.DrawFront(triangle);
  });
  const Mask none(width, height);
  Bust bust{none, none, none, VectorImage(width, height, {0, 0, 1}), pose.Project({}).x};
  ForEachPixel(width, height, [&](int x, int y, std::size_t i) {
    const SurfaceSample* sample = surface.SampleAt(x, y);
    if (!sample) return;
    const MeshPoint on_base = sample->OnMesh();
    const glm::vec3 normal = on_base.On(base.rest().normal);
    if (normal.z <= 0) return;  // interpolated normals at the outline may point away
    bust.opacity[i] = 1;
    bust.cloth[i] = sample->triangle.material == fsm::Material::kCloth ? 1.0F : 0.0F;
    bust.ambient_occlusion[i] = on_base.On(mesh.openness);
    bust.normal[i] = normal;
  });
  return bust;
}

}  // namespace

float Bust::HalfWidth(PhotoEdge side, float row) const {
  const int y = std::clamp(static_cast<int>(row), 0, opacity.height - 1);
  const int step = side == PhotoEdge::kLeft ? -1 : 1;
  int x = std::clamp(static_cast<int>(axis), 0, opacity.width - 1);
  while (x >= 0 && x < opacity.width && opacity(x, y) > 0.5F) x += step;
  return std::max(std::abs(static_cast<float>(x) + 0.5F - axis), 1.0F);
}

Bust DrawBust(const FittedHead& fitted, const CameraPose& pose, int width, int height) {
  // A pixel of a small photo covers much of the outline, so each is the mean of several samples.
  constexpr float kSamplesPerMm = 3;
  const int finer =
      std::clamp(static_cast<int>(std::ceil(kSamplesPerMm / pose.PixelsPerMm())), 1, 4);
  CameraPose finer_pose = pose;
  finer_pose.focal_px *= static_cast<float>(finer);
  finer_pose.centre_px *= static_cast<float>(finer);
  Bust bust = DrawWith(fitted, finer_pose, finer * width, finer * height);
  bust.axis /= static_cast<float>(finer);
  for (Mask* image : {&bust.opacity, &bust.cloth, &bust.ambient_occlusion}) {
    *image = ScaledDown(*image, width, height);
  }
  bust.normal = ScaledDown(bust.normal, width, height);
  return bust;
}

}  // namespace facefit
