#include "fsm/render/mouth_finder.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace fsm {

MouthFinder::MouthFinder(const MouthVertices& mouth) {
  if (mouth.seam.size() >= kColumns && mouth.corners && mouth.incisors) mouth_ = mouth;
}

void MouthFinder::AppendVertices(std::vector<std::uint32_t>& out) const {
  if (!mouth_) return;
  out.insert(out.end(),
             {mouth_->corners->right, mouth_->corners->left, mouth_->incisors->upper_root,
              mouth_->incisors->upper, mouth_->incisors->lower});
  for (const auto& [upper, lower] : mouth_->seam) out.insert(out.end(), {upper, lower});
}

std::optional<MouthFinder::Opening> MouthFinder::Measure(const HeadVertices& vertices) const {
  if (!mouth_) return std::nullopt;
  const auto at = [&vertices](std::uint32_t i) { return vertices.position[i]; };
  const Sided<std::uint32_t>& corners = *mouth_->corners;
  const Incisors& incisors = *mouth_->incisors;
  const glm::vec3 right = at(corners.right), left = at(corners.left);
  const glm::vec3 middle = 0.5f * (right + left);
  // The teeth's frame is upright in the skull, whatever the lips do.
  const auto unit = [](glm::vec3 v, glm::vec3 otherwise) {
    return glm::length(v) > 1 ? glm::normalize(v) : otherwise;
  };
  const glm::vec3 x = unit(left - right, {1, 0, 0});
  glm::vec3 y = at(incisors.upper_root) - at(incisors.upper);
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
    const auto [upper, lower] = mouth_->seam[(2 * k + 1) * mouth_->seam.size() / (2 * kColumns)];
    opening.lips[k] = in_mouth(upper);
    opening.lips[k + kColumns] = in_mouth(lower);
  }
  opening.corners = {in_mouth(corners.right).x, in_mouth(corners.left).x};
  opening.teeth = {in_mouth(incisors.upper).y, in_mouth(incisors.lower).y};
  return opening;
}

bool MouthFinder::Opening::IsShut() const {
  constexpr float kShut = 0.02f;  // millimetres; less than a sample of any picture
  for (std::size_t k = 0; k < kColumns; ++k) {
    // Lips that touch have the same depth.
    const glm::vec3 apart = lips[k] - lips[k + kColumns];
    if (apart.y > kShut || std::abs(apart.z) > kShut) return false;
  }
  return true;
}

}  // namespace fsm
