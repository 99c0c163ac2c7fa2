#include "fsm/render/mouth_finder.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace fsm {

MouthFinder::MouthFinder(const HeadTopology& topology) {
  if (topology.mouth.seam.size() >= kColumns) slit_ = topology.mouth;
}

void MouthFinder::AppendVertices(std::vector<std::uint32_t>& out) const {
  if (!slit_) return;
  out.insert(out.end(), {slit_->corner_right, slit_->corner_left, slit_->upper_root,
                         slit_->upper_incisor, slit_->lower_incisor});
  for (const auto& [upper, lower] : slit_->seam) out.insert(out.end(), {upper, lower});
}

std::optional<MouthFinder::Opening> MouthFinder::Measure(const HeadVertices& vertices) const {
  if (!slit_) return std::nullopt;
  const auto at = [&vertices](std::uint32_t i) { return vertices.position[i]; };
  const glm::vec3 right = at(slit_->corner_right), left = at(slit_->corner_left);
  const glm::vec3 middle = 0.5F * (right + left);
  // The teeth's frame is upright in the skull, whatever the lips do.
  const auto unit = [](glm::vec3 v, glm::vec3 otherwise) {
    return glm::length(v) > 1 ? glm::normalize(v) : otherwise;
  };
  const glm::vec3 x = unit(left - right, {1, 0, 0});
  glm::vec3 y = at(slit_->upper_root) - at(slit_->upper_incisor);
  y = unit(y - x * glm::dot(x, y), {0, 1, 0});
  const glm::mat4 frame(glm::vec4(x, 0), glm::vec4(y, 0), glm::vec4(glm::cross(x, y), 0),
                        glm::vec4(middle, 1));
  Opening opening{};
  opening.to_mouth = glm::inverse(frame);
  const auto in_mouth = [&](std::uint32_t i) {
    return glm::vec3(opening.to_mouth * glm::vec4(at(i), 1));
  };
  for (std::size_t k = 0; k < kColumns; ++k) {
    // Takes the middle vertex of each of kColumns equal sections of the seam.
    const auto [upper, lower] = slit_->seam[(2 * k + 1) * slit_->seam.size() / (2 * kColumns)];
    opening.lips[k] = in_mouth(upper);
    opening.lips[k + kColumns] = in_mouth(lower);
  }
  opening.corners = {in_mouth(slit_->corner_right).x, in_mouth(slit_->corner_left).x};
  opening.teeth = {in_mouth(slit_->upper_incisor).y, in_mouth(slit_->lower_incisor).y};
  return opening;
}

bool MouthFinder::Opening::IsShut() const {
  constexpr float kShut = 0.02F;  // millimetres; less than a sample of any picture
  for (std::size_t k = 0; k < kColumns; ++k) {
    // Lips that touch have the same depth.
    const glm::vec3 apart = lips[k] - lips[k + kColumns];
    if (apart.y > kShut || std::abs(apart.z) > kShut) return false;
  }
  return true;
}

}  // namespace fsm
