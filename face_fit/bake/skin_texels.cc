#include "face_fit/bake/skin_texels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <span>

#include "face_fit/bake/skin_surface.h"
#include "face_fit/picture/plane.h"
#include "face_fit/surface/mesh_point.h"
#include "face_fit/surface/rasterizer.h"
#include "face_fit/surface/triangles.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Whether the head itself hides a place of its skin from the camera, as the jaw does the throat.
class SelfOcclusion {
 public:
  SelfOcclusion(const FittedHead& fitted, const CameraPose& pose) : pose_(pose) {
    const glm::vec2 middle = pose.Project({0, 0, 0});
    const float reach = kReach * pose.PixelsPerMm();
    const float cell = 2 * reach / kCells;
    grid_ = {middle - reach, cell, kCells, kCells};
    nearest_ = SeenSkin(fitted, pose, grid_, -1e9F).depth();
  }
  bool operator()(glm::vec3 camera) const {
    const glm::vec2 at = (pose_.Project(camera) - grid_.origin) / grid_.step + 0.5F;
    const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
    if (x < 1 || y < 1 || x + 1 >= kCells || y + 1 >= kCells) return false;
    constexpr float kBehind = 5;  // millimetres
    for (int k = 0; k < 9; ++k) {
      const float z = nearest_(x + k % 3 - 1, y + k / 3 - 1);
      if (z < camera.z + kBehind) return false;
    }
    return true;
  }

 private:
  static constexpr int kCells = 256;
  static constexpr float kReach = 180;  // millimetres
  const CameraPose& pose_;
  SampleGrid grid_{};
  FloatImage nearest_;
};

/// Where the lips of the base head at rest meet and end, in millimetres.
class LipLines {
 public:
  explicit LipLines(const BaseHead& base)
      : seam_(Line(base, point::kUpperInnerLip, {})),
        upper_(Line(base, point::kUpperOuterLip, kCorners)),
        lower_(Line(base, point::kLowerOuterLip, kCorners)) {}
  float OffSeam(glm::vec3 p) const {
    if (!Spans(seam_, p)) return 1e9F;
    const float off = std::abs(p.y - HeightAt<glm::vec3>(seam_, p.x));
    // Towards its ends the line grows thin.
    const float to_end = std::min(p.x - seam_.front().x, seam_.back().x - p.x);
    return off + 0.2F * std::max(7 - to_end, 0.0F);
  }
  float Within(glm::vec3 p) const {
    if (!Spans(upper_, p)) return -1e9F;
    return std::min(HeightAt<glm::vec3>(upper_, p.x) - p.y, p.y - HeightAt<glm::vec3>(lower_, p.x));
  }

 private:
  static constexpr std::array kCorners = {point::kMouthRight, point::kMouthLeft};
  static bool Spans(std::span<const glm::vec3> line, glm::vec3 p) {
    constexpr float kFront = 60;  // behind it lies the mouth's inside
    return p.x >= line.front().x && p.x <= line.back().x && p.z >= kFront;
  }
  static std::vector<glm::vec3> Line(const BaseHead& base, std::span<const PointIndex> points,
                                     std::span<const PointIndex> ends) {
    std::vector<PointIndex> all(points.begin(), points.end());
    if (!ends.empty()) {
      all.insert(all.begin(), ends.front());
      all.push_back(ends.back());
    }
    std::vector<glm::vec3> line;
    for (const PointIndex i : all) line.push_back(base.AtRest(i));
    return line;
  }
  std::vector<glm::vec3> seam_, upper_, lower_;
};

/// Normals of the vertices of the skin, their lengths by the areas around.
std::vector<glm::vec3> SkinNormals(const fsm::HeadTopology& topology,
                                   const std::vector<glm::vec3>& position) {
  std::vector<glm::vec3> normal(position.size(), glm::vec3(0));
  ForSkinTriangles(topology, [&](const std::uint32_t* t) {
    const glm::vec3 n =
        glm::cross(position[t[1]] - position[t[0]], position[t[2]] - position[t[0]]);
    for (int c = 0; c < 3; ++c) normal[t[c]] += n;
  });
  return normal;
}

/// A triangle of the skin in texels of its map; nothing if it runs across the seam of the map.
std::optional<Triangle2> OnMap(const fsm::HeadTopology& topology, const std::uint32_t* t) {
  const auto texel = [&](std::uint32_t v) {
    return glm::vec2(topology.uv[v].x, 1 - topology.uv[v].y) * static_cast<float>(kMapSize) - 0.5F;
  };
  const Triangle2 out{texel(t[0]), texel(t[1]), texel(t[2])};
  const float wide = std::max({out.a.x, out.b.x, out.c.x}) - std::min({out.a.x, out.b.x, out.c.x});
  if (wide > kMapSize / 4.0F) return std::nullopt;
  return out;
}

}  // namespace

SkinTexels ProjectSkin(const FittedHead& fitted, const CameraPose& pose, bool hidden) {
  const BaseHead& base = *fitted.base;
  const glm::vec2 across = PhotoLook().Pair("aside_across");
  const glm::vec2 above_chin = PhotoLook().Pair("aside_above_chin");
  constexpr float kSlack = 0.02F;
  constexpr glm::vec3 kEye(0, 0, kCameraZ);
  std::optional<SelfOcclusion> hides;
  if (hidden) hides.emplace(fitted, pose);
  const auto& topology = base.head->topology();
  std::vector<glm::vec3> camera;
  for (const glm::vec3& p : fitted.posed_vertices) camera.push_back(pose.ToCamera(p));
  const std::vector<glm::vec3> normal = SkinNormals(topology, camera);
  const float brows = base.head->Landmark("nasion").y + kBrowsEnd;
  const float chin = base.AtRest(point::kChin).y;
  const LipLines lips(base);
  SkinTexels out(kMapSize, kMapSize);
  ForSkinTriangles(topology, [&](const std::uint32_t* t) {
    const auto triangle = OnMap(topology, t);
    if (!triangle) return;
    Rasterize(*triangle, kMapSize, kMapSize, kSlack, [&](int x, int y, glm::vec3 weights) {
      const MeshPoint place{{t[0], t[1], t[2]}, weights};
      const glm::vec3 rest = place.On(base.rest.position);
      const float outward = rest.x * rest.x + rest.z * rest.z;
      const std::size_t i = out.Index(x, y);
      if (outward <= out.at[i].outward) return;
      const glm::vec3 q = place.On(camera);
      const glm::vec3 n = place.On(normal) + glm::vec3(0, 0, 1e-9F);
      out.at[i].outward = outward;
      out.at[i].pixel = pose.Project(q);
      out.at[i].x_mm = rest.x;
      out.at[i].above_brows_mm = rest.y - brows;
      out.at[i].off_seam_mm = lips.OffSeam(rest);
      out.at[i].within_lips_mm = lips.Within(rest);
      out.at[i].aside = std::max(Ramp(across, std::abs(rest.x)), Ramp(above_chin, rest.y - chin));
      out.at[i].facing =
          hides && (*hides)(q) ? -1.0F : glm::dot(glm::normalize(n), glm::normalize(kEye - q));
    });
  });
  return out;
}

}  // namespace facefit
