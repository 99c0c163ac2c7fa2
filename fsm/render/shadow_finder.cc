#include "fsm/render/shadow_finder.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

namespace fsm {
namespace {

// In the rest frame, millimetres. A surface that faces the light has its ellipsoid behind it, so
// the ellipsoids may reach through the surface without shading it.
constexpr glm::vec3 kSkullCentre{0.0f, -10.0f, 18.0f};
constexpr glm::vec3 kSkullRadii{66.0f, 108.0f, 80.0f};
constexpr glm::vec3 kNoseInset{0.0f, 3.0f, -13.0f};  // of the centre from the tip of the nose
constexpr glm::vec3 kNoseRadii{9.0f, 11.0f, 13.0f};
/// Anchors at the sides are searched between these heights, millimetres.
constexpr float kLowestSide = 0.0f;
constexpr float kHighestSide = 60.0f;

glm::mat4 ToUnitSphere(const glm::vec3& centre, const glm::vec3& radii) {
  return glm::translate(glm::scale(glm::mat4(1.0f), 1.0f / radii), -centre);
}

}  // namespace

ShadowFinder::ShadowFinder(const HeadSurface& surface, const HeadVertices& rest) {
  for (const auto& part : surface.parts) {
    if (part.material != Material::kSkin || part.index_count == 0) continue;
    const auto first = surface.indices[part.first_index];
    if (!anchors_) anchors_ = Anchors{first, {first, first}};
    Anchors& found = *anchors_;
    for (const auto i : surface.Corners(part)) {
      const auto& p = rest.position[i];
      if (p.z > rest.position[found.nose].z) found.nose = i;
      if (p.y < kLowestSide || p.y > kHighestSide) continue;
      if (p.x < rest.position[found.sides.right].x) found.sides.right = i;
      if (p.x > rest.position[found.sides.left].x) found.sides.left = i;
    }
  }
  if (anchors_) rest_to_space_ = glm::inverse(SpaceOf(rest));
}

glm::mat4 ShadowFinder::SpaceOf(const HeadVertices& vertices) const {
  const glm::vec3 right = vertices.position[anchors_->sides.right];
  const glm::vec3 left = vertices.position[anchors_->sides.left];
  const glm::vec3 middle = (right + left) / 2.0f;
  glm::vec3 x = left - right;
  glm::vec3 z = vertices.position[anchors_->nose] - middle;
  // A degenerate head keeps the given axes.
  x = glm::length(x) > 1 ? glm::normalize(x) : glm::vec3(1.0f, 0.0f, 0.0f);
  z -= x * glm::dot(x, z);
  z = glm::length(z) > 1 ? glm::normalize(z) : glm::vec3(0.0f, 0.0f, 1.0f);
  const glm::vec3 y = glm::cross(z, x);
  return {glm::vec4(x, 0.0f), glm::vec4(y, 0.0f), glm::vec4(z, 0.0f), glm::vec4(middle, 1.0f)};
}

void ShadowFinder::AppendVertices(std::vector<std::uint32_t>& out) const {
  if (anchors_)
    out.insert(out.end(), {anchors_->nose, anchors_->sides.right, anchors_->sides.left});
}

ShadowFinder::Occluders ShadowFinder::Measure(const HeadVertices& vertices) const {
  constexpr glm::vec3 kNowhere{0.0f, 0.0f, -1e6f};
  if (!anchors_) {
    const glm::mat4 nothing = ToUnitSphere(kNowhere, glm::vec3(1.0f));
    return {nothing, nothing, glm::mat3(1.0f)};
  }
  const glm::mat4 space = SpaceOf(vertices);
  const glm::mat4 to_rest = glm::inverse(space * rest_to_space_);
  const glm::vec3 nose(to_rest * glm::vec4(vertices.position[anchors_->nose], 1.0f));
  return {ToUnitSphere(kSkullCentre, kSkullRadii) * to_rest,
          ToUnitSphere(nose + kNoseInset, kNoseRadii) * to_rest, glm::mat3(space * rest_to_space_)};
}

}  // namespace fsm
