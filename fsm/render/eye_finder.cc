#include "fsm/render/eye_finder.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <span>

namespace fsm {
namespace {

/// Skin within this distance (mm) of the eyeball's surface may be a lid.
constexpr float kLidReach = 4.0f;
/// Only lid margins above and below the pupil count, within this distance (mm) to its sides.
constexpr float kRimHalfWidth = 4.5f;

std::vector<std::uint32_t> VerticesOf(const HeadSurface& surface, Material material) {
  std::vector<std::uint32_t> found;
  for (const auto& part : surface.parts) {
    if (part.material != material) continue;
    const auto corners = surface.Corners(part);
    found.insert(found.end(), corners.begin(), corners.end());
  }
  std::ranges::sort(found);
  const auto rest = std::ranges::unique(found);
  found.erase(rest.begin(), rest.end());
  return found;
}

glm::vec3 Centroid(std::span<const std::uint32_t> points, const HeadVertices& vertices) {
  glm::vec3 sum(0.0f);
  for (const auto i : points) sum += vertices.position[i];
  return points.empty() ? sum : sum / static_cast<float>(points.size());
}

/// Fits a sphere to points by least squares: |p|^2 = 2 c.p + (r^2 - |c|^2) is linear in the centre
/// c and in the bracket. Positions are relative to their centroid for precision.
void FitSphere(std::span<const std::uint32_t> points, const HeadVertices& vertices,
               MeasuredEye& out) {
  const glm::dvec3 origin = Centroid(points, vertices);
  glm::dmat4 normal(0.0);
  glm::dvec4 right(0.0);
  for (const auto i : points) {
    const glm::dvec3 p = glm::dvec3(vertices.position[i]) - origin;
    const glm::dvec4 row(2.0 * p, 1.0);
    normal += glm::outerProduct(row, row);
    right += row * glm::dot(p, p);
  }
  if (std::abs(glm::determinant(normal)) < 1e-6) {
    out.centre = glm::vec3(origin);
    return;
  }
  const glm::dvec4 solution = glm::inverse(normal) * right;
  const glm::dvec3 centre(solution);
  out.centre = glm::vec3(origin + centre);
  out.radius = static_cast<float>(std::sqrt(std::max(solution.w + glm::dot(centre, centre), 1.0)));
}

/// Returns the height of the lowest or highest point; `otherwise` if there are none.
float Extreme(std::span<const std::uint32_t> points, const HeadVertices& vertices, bool lowest,
              float otherwise) {
  if (points.empty()) return otherwise;
  const auto height = [&](std::uint32_t i) { return vertices.position[i].y; };
  const auto [low, high] = std::ranges::minmax(points, {}, height);
  return height(lowest ? low : high);
}

}  // namespace

EyeFinder::EyeFinder(const HeadSurface& surface, const HeadVertices& rest) {
  const auto side_of = [&rest](std::uint32_t i) {
    return rest.position[i].x < 0 ? Side::kRight : Side::kLeft;
  };
  for (const auto i : VerticesOf(surface, Material::kSclera)) white_[side_of(i)].push_back(i);
  for (const auto i : VerticesOf(surface, Material::kIris)) iris_[side_of(i)].push_back(i);
  if (!found()) return;
  const auto eyes = Measure(rest);
  for (const auto i : VerticesOf(surface, Material::kSkin)) {
    const Side side = side_of(i);
    const auto& eye = eyes[side];
    const glm::vec3 p = rest.position[i] - eye.centre;
    if (p.z <= 0 || std::abs(p.x) > kRimHalfWidth) continue;
    if (std::abs(glm::length(p) - eye.radius) > kLidReach) continue;
    (p.y > 0 ? upper_rim_ : lower_rim_)[side].push_back(i);
  }
}

void EyeFinder::AppendVertices(std::vector<std::uint32_t>& out) const {
  for (const auto* sides : {&white_, &iris_, &upper_rim_, &lower_rim_}) {
    for (const Side side : kSides) {
      out.insert(out.end(), (*sides)[side].begin(), (*sides)[side].end());
    }
  }
}

Sided<MeasuredEye> EyeFinder::Measure(const HeadVertices& vertices) const {
  Sided<MeasuredEye> eyes;
  for (const Side side : kSides) {
    auto& eye = eyes[side];
    FitSphere(white_[side], vertices, eye);
    if (!iris_[side].empty()) {
      const glm::vec3 pupil = Centroid(iris_[side], vertices);
      const glm::vec3 outward = pupil - eye.centre;
      if (glm::length(outward) > 1e-3f) eye.gaze = glm::normalize(outward);
      eye.iris_radius = 0;
      for (const auto i : iris_[side]) {
        const glm::vec3 p = vertices.position[i] - pupil;
        const float across = glm::length(p - eye.gaze * glm::dot(p, eye.gaze));
        eye.iris_radius = std::max(eye.iris_radius, across);
      }
      eye.iris_radius = std::max(eye.iris_radius, 1.0f);
    }
    eye.upper_lid_y = Extreme(upper_rim_[side], vertices, true, eye.centre.y + eye.radius * 0.45f);
    eye.lower_lid_y = Extreme(lower_rim_[side], vertices, false, eye.centre.y - eye.radius * 0.45f);
  }
  return eyes;
}

}  // namespace fsm
