#include "fsm/mesh/unrigged_head.h"

#include <algorithm>
#include <cmath>

#include "fsm/base/pi.h"
#include "fsm/head/identity.h"

namespace fsm {

std::uint32_t UnriggedHead::Add(glm::vec3 p, Bone b, glm::vec3 colour, std::optional<glm::vec2> at,
                                float neck) {
  textures.texcoord.push_back(at.value_or(glm::vec2(0)));
  textures.weight.push_back(at ? 1.0f : 0.0f);
  return mesh.Add(p, colour, 1, b, {.skin = {.neck = neck}});
}

namespace {

/// Returns the triangles whose corners all belong to bones that `is` accepts.
template <typename Is>
std::vector<std::uint32_t> TrianglesOf(const UnriggedHead& model, Is is) {
  std::vector<std::uint32_t> out;
  for (const auto& batch : model.mesh.batches) {
    for (std::size_t i = 0; i + 2 < batch.indices.size(); i += 3) {
      const std::uint32_t* t = &batch.indices[i];
      if (std::all_of(t, t + 3, [&](std::uint32_t v) { return is(model.mesh.bone[v]); })) {
        out.insert(out.end(), t, t + 3);
      }
    }
  }
  return out;
}

}  // namespace

std::vector<std::uint32_t> UnriggedHead::FleshTriangles() const {
  return TrianglesOf(*this, [](Bone b) { return b == Bone::kSkin; });
}

std::vector<std::uint32_t> UnriggedHead::EyeTriangles() const {
  return TrianglesOf(*this, [](Bone b) { return SideOfEye(b).has_value(); });
}

void UnriggedHead::AddEyeball(Side side) {
  // Rings about the line of sight; one is the edge of the iris.
  constexpr int kSegments = 32, kIrisRings = 4, kRings = 14;
  const EyeGeometry& eye = eyes[side];
  const float edge = std::asin(std::min(eye.iris_radius / eye.ball_radius, 0.9f));
  const Bone carrier = BoneOf(side);
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (int ring = 0; ring <= kRings; ++ring) {
    const float angle = ring <= kIrisRings
                            ? edge * static_cast<float>(ring) / kIrisRings
                            : edge + (0.7f * kPi - edge) * static_cast<float>(ring - kIrisRings) /
                                         (kRings - kIrisRings);
    for (int k = 0; k < kSegments; ++k) {
      const float turn = 2 * kPi * static_cast<float>(k) / kSegments;
      const glm::vec3 out(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                          std::cos(angle));
      Add(eye_rig.centre[side] + eye.ball_radius * out, carrier, BasePalette().sclera);
    }
  }
  for (int ring = 0; ring < kRings; ++ring) {
    const Material material = ring < kIrisRings ? Material::kIris : Material::kSclera;
    for (std::uint32_t k = 0; k < kSegments; ++k) {
      const auto at = [&](int r, std::uint32_t s) {
        return first + static_cast<std::uint32_t>(r) * kSegments + s % kSegments;
      };
      mesh.Triangle(material, at(ring, k), at(ring + 1, k), at(ring + 1, k + 1));
      mesh.Triangle(material, at(ring, k), at(ring + 1, k + 1), at(ring, k + 1));
    }
  }
}

}  // namespace fsm
