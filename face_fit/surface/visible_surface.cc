#include "face_fit/surface/visible_surface.h"

#include <glm/common.hpp>
#include <utility>

#include "face_fit/surface/rasterizer.h"
#include "face_fit/surface/triangles.h"

namespace facefit {

VisibleSurface::VisibleSurface(const SampleGrid& grid, std::vector<glm::vec3> screen)
    : grid_(grid),
      screen_(std::move(screen)),
      depth_(grid.columns, grid.rows, kNothing),
      samples_(depth_.at.size()) {}

void VisibleSurface::Draw(const std::uint32_t* triangle) {
  constexpr float kSlack = 0.01F;  // of a weight: no point between two triangles is lost
  const auto on_grid = [&](int corner) {
    return (glm::vec2(screen_[triangle[corner]]) - grid_.origin) / grid_.step;
  };
  Rasterize({on_grid(0), on_grid(1), on_grid(2)}, grid_.columns, grid_.rows, kSlack,
            [&](int column, int row, glm::vec3 weights) {
              const MeshPoint place{{triangle[0], triangle[1], triangle[2]}, weights};
              const float z = place.On(screen_).z;
              const std::size_t i = depth_.Index(column, row);
              if (z <= depth_.at[i]) return;
              depth_.at[i] = z;
              samples_[i] = {triangle, weights};
            });
}

void VisibleSurface::DrawFront(const std::uint32_t* triangle) {
  const Triangle2 seen{screen_[triangle[0]], screen_[triangle[1]], screen_[triangle[2]]};
  if (seen.SignedArea() < 0) Draw(triangle);
}

FloatImage VisibleSurface::Covered() const {
  return FloatImage::From(depth_.width, depth_.height,
                          [&](int x, int y) { return depth_(x, y) > kNothing ? 1.0F : 0.0F; });
}

const std::uint32_t* VisibleSurface::Triangle(int column, int row) const {
  if (column < 0 || row < 0 || column >= grid_.columns || row >= grid_.rows) return nullptr;
  return samples_[depth_.Index(column, row)].triangle;
}

MeshPoint VisibleSurface::Place(int column, int row) const {
  const auto& [t, weights] = samples_[depth_.Index(column, row)];
  return {{t[0], t[1], t[2]}, weights};
}

VisibleSurface SeenFromFront(const fsm::HeadTopology& topology,
                             const std::vector<glm::vec3>& position, glm::vec2 low,
                             glm::vec2 high) {
  constexpr float kMostMm = 200;
  const glm::ivec2 points(glm::clamp(high - low, 1.0F, kMostMm) / kFrontStepMm);
  VisibleSurface surface({low + 0.5F * kFrontStepMm, kFrontStepMm, points.x, points.y}, position);
  const auto opaque = [](fsm::Material m) { return !IsHair(m) && m != fsm::Material::kShutLash; };
  ForTriangles(topology, opaque, [&](const std::uint32_t* t) {
    const Triangle2 seen{position[t[0]], position[t[1]], position[t[2]]};
    if (seen.SignedArea() > 0) surface.Draw(t);
  });
  return surface;
}

}  // namespace facefit
