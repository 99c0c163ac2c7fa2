#include "face_fit/bake/skin_texels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>

#include "face_fit/bake/skin_surface.h"
#include "face_fit/image/plane.h"
#include "face_fit/surface/rasterizer.h"
#include "face_fit/surface/triangles.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// The lip seam and the outer borders of the base head's lips at rest, millimetres.
class LipLines {
 public:
  explicit LipLines(const ObservedHead& base)
      : lip_seam_(Line(base, point::kUpperInnerLip, point::kInnerMouthCorners)),
        upper_(Line(base, point::kUpperOuterLip, point::kMouthCorners)),
        lower_(Line(base, point::kLowerOuterLip, point::kMouthCorners)) {}
  float OffLipSeam(glm::vec3 p) const {
    // A larger distance near its ends makes the line thinner.
    constexpr float kThinMm = 7, kThinner = 0.2F;
    if (!Spans(lip_seam_, p)) return SkinTexel::kNotNear;
    const float gap_mm = std::abs(p.y - LineYAt<glm::vec3>(lip_seam_, p.x));
    const float to_end_mm = std::min(p.x - lip_seam_.front().x, lip_seam_.back().x - p.x);
    return gap_mm + kThinner * std::max(kThinMm - to_end_mm, 0.0F);
  }
  float Within(glm::vec3 p) const {
    if (!Spans(upper_, p)) return -SkinTexel::kNotNear;
    return std::min(LineYAt<glm::vec3>(upper_, p.x) - p.y, p.y - LineYAt<glm::vec3>(lower_, p.x));
  }

 private:
  static bool Spans(std::span<const glm::vec3> line, glm::vec3 p) {
    constexpr float kFrontMm = 60;  // behind it lies the inside of the mouth
    return p.x >= line.front().x && p.x <= line.back().x && p.z >= kFrontMm;
  }
  static std::vector<glm::vec3> Line(const ObservedHead& base, std::span<const PointIndex> lip,
                                     const point::Group<2>& corners) {
    std::vector<glm::vec3> line;
    for (const PointIndex i : WithCorners(lip, corners)) line.push_back(base.AtRest(i));
    return line;
  }
  std::vector<glm::vec3> lip_seam_, upper_, lower_;
};

/// Returns the normals of the skin's vertices, not normalised, weighted by area.
std::vector<glm::vec3> SkinNormals(const fsm::HeadSurface& surface,
                                   const std::vector<glm::vec3>& position) {
  std::vector<glm::vec3> normal(position.size(), glm::vec3(0));
  ForEachSkinAndLipTriangle(surface, [&](const MeshTriangle& triangle) {
    for (const std::uint32_t v : triangle.corner) normal[v] += triangle.Normal(position);
  });
  return normal;
}

/// Returns a triangle of the skin in texels of the map; nothing if it crosses the uv seam.
std::optional<Triangle2> OnMap(const fsm::HeadSurface& surface, const MeshTriangle& triangle) {
  const auto texel = [&](std::uint32_t v) {
    return glm::vec2(surface.uv[v].x, 1 - surface.uv[v].y) * static_cast<float>(kMapSize) - 0.5F;
  };
  constexpr float kAcrossUvSeam =
      kMapSize / 4.0F;  // wider than any triangle that does not cross it
  const auto& [a, b, c] = triangle.corner;
  const Triangle2 out{texel(a), texel(b), texel(c)};
  const float width = std::max({out.a.x, out.b.x, out.c.x}) - std::min({out.a.x, out.b.x, out.c.x});
  if (width > kAcrossUvSeam) return std::nullopt;
  return out;
}

}  // namespace

SkinTexels FindSkinTexels(const ObservedHead& base) {
  const auto& head_side = PhotoLook().head_side;
  constexpr float kSlack = 0.02F;
  const auto& surface = base.surface();
  const float chin_y_mm = base.AtRest(point::kChin).y;
  const LipLines lips(base);
  SkinTexels out(kMapSize, kMapSize);
  // Of the triangles that share a texel the one farthest from the head's vertical axis counts.
  FloatImage outward_mm2(kMapSize, kMapSize, -1);
  ForEachSkinAndLipTriangle(surface, [&](const MeshTriangle& triangle) {
    const auto on_map = OnMap(surface, triangle);
    if (!on_map) return;
    Rasterize(*on_map, kMapSize, kMapSize, kSlack, [&](int x, int y, glm::vec3 weights) {
      const MeshPoint on_mesh{triangle.corner, weights};
      const glm::vec3 rest = on_mesh.On(base.rest().position);
      const float outward = rest.x * rest.x + rest.z * rest.z;
      if (outward <= outward_mm2(x, y)) return;
      outward_mm2(x, y) = outward;
      out(x, y) = {.on_mesh = on_mesh,
                   .x_mm = rest.x,
                   .y_mm = rest.y,
                   .off_lip_seam_mm = lips.OffLipSeam(rest),
                   .within_lips_mm = lips.Within(rest),
                   .flank_weight = std::max(head_side.across_mm.Ramp(std::abs(rest.x)),
                                            head_side.above_chin_mm.Ramp(rest.y - chin_y_mm))};
    });
  });
  return out;
}

TexelProjections ProjectTexels(const FittedHead& fitted, const SkinTexels& texels,
                               const CameraPose& pose) {
  constexpr glm::vec3 kCameraPosition(0, 0, kCameraDepthMm);
  const std::vector<glm::vec3> in_camera = pose.ToCamera(fitted.vertices);
  const std::vector<glm::vec3> normal = SkinNormals(fitted.base->surface(), in_camera);
  TexelProjections out(texels.width, texels.height);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (!texels[i]) continue;
    const glm::vec3 q = texels[i]->on_mesh.On(in_camera);
    const glm::vec3 n = texels[i]->on_mesh.On(normal) + glm::vec3(0, 0, 1e-9F);
    out[i] = TexelProjection{pose.Project(q), q.z,
                             glm::dot(glm::normalize(n), glm::normalize(kCameraPosition - q))};
  }
  return out;
}

void HideSelfOccluded(const FittedHead& fitted, const CameraPose& pose,
                      TexelProjections& projections) {
  constexpr int kCells = 256;
  constexpr float kGridReachMm = 180, kNoBottom = -1e9F, kBehindMm = 5;
  const float reach = kGridReachMm * pose.PixelsPerMm();
  const SampleGrid grid{pose.Project({0, 0, 0}) - reach, 2 * reach / kCells, kCells, kCells};
  const FloatImage nearest = VisibleSkin(fitted, pose, grid, kNoBottom).depth();
  const auto hidden = [&](const TexelProjection& texel) {
    const glm::vec2 cell = (texel.pixel - grid.origin) / grid.step + 0.5F;
    const int x = static_cast<int>(cell.x), y = static_cast<int>(cell.y);
    if (x < 1 || y < 1 || x + 1 >= kCells || y + 1 >= kCells) return false;
    return std::ranges::none_of(kAround, [&](glm::ivec2 offset) {
      return nearest(x + offset.x, y + offset.y) < texel.z_mm + kBehindMm;
    });
  };
  for (auto& texel : projections.values) {
    if (texel && hidden(*texel)) texel.reset();
  }
}

}  // namespace facefit
