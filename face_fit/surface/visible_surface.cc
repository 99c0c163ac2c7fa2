#include "face_fit/surface/visible_surface.h"

#include <glm/common.hpp>
#include <utility>

#include "face_fit/surface/rasterizer.h"

namespace facefit {

VisibleSurface::VisibleSurface(const SampleGrid& grid, std::vector<glm::vec3> screen, Upward upward)
    : grid_(grid),
      screen_(std::move(screen)),
      front_sign_(upward == Upward::kYes ? 1.0F : -1.0F),
      depth_(grid.columns, grid.rows, kNothing),
      samples_(depth_.size()) {}

void VisibleSurface::Draw(const MeshTriangle& triangle) {
  constexpr float kSlack = 0.01F;  // of a weight: no point between two triangles is lost
  const auto on_grid = [&](std::size_t corner) {
    return (glm::vec2(screen_[triangle.corner[corner]]) - grid_.origin) / grid_.step;
  };
  Rasterize({on_grid(0), on_grid(1), on_grid(2)}, grid_.columns, grid_.rows, kSlack,
            [&](int column, int row, glm::vec3 weights) {
              const float z = MeshPoint{triangle.corner, weights}.On(screen_).z;
              const std::size_t i = depth_.Index(column, row);
              if (z <= depth_[i]) return;
              depth_[i] = z;
              samples_[i] = {triangle, weights};
            });
}

void VisibleSurface::DrawFront(const MeshTriangle& triangle) {
  const auto& [a, b, c] = triangle.corner;
  if (front_sign_ * Triangle2{screen_[a], screen_[b], screen_[c]}.SignedArea() > 0) Draw(triangle);
}

Mask VisibleSurface::Covered() const {
  return Mask::From(depth_.width, depth_.height,
                    [&](int x, int y) { return depth_(x, y) > kNothing ? 1.0F : 0.0F; });
}

const SurfaceSample* VisibleSurface::SampleAt(int column, int row) const {
  if (column < 0 || row < 0 || column >= grid_.columns || row >= grid_.rows) return nullptr;
  return depth_(column, row) > kNothing ? &samples_[depth_.Index(column, row)] : nullptr;
}

VisibleSurface DrawSkin(const fsm::HeadSurface& mesh, std::vector<glm::vec3> screen,
                        const SampleGrid& grid) {
  VisibleSurface surface(grid, std::move(screen));
  ForEachSkinAndLipTriangle(mesh, [&](const MeshTriangle& t) { surface.DrawFront(t); });
  return surface;
}

VisibleSurface VisibleFromFront(const fsm::HeadSurface& mesh,
                                const std::vector<glm::vec3>& position, glm::vec2 low,
                                glm::vec2 high) {
  constexpr float kMaxMm = 200;
  const glm::ivec2 points(glm::clamp(high - low, 1.0F, kMaxMm) / kFrontStepMm);
  VisibleSurface surface({low + 0.5F * kFrontStepMm, kFrontStepMm, points.x, points.y}, position,
                         VisibleSurface::Upward::kYes);
  const auto opaque = [](fsm::Material m) { return !IsHair(m) && m != fsm::Material::kShutLash; };
  ForEachTriangle(mesh, opaque, [&](const MeshTriangle& t) { surface.DrawFront(t); });
  return surface;
}

}  // namespace facefit
