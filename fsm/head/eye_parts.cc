#include "fsm/head/eye_parts.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "fsm/base/pi.h"
#include "fsm/head/paint_stream.h"

namespace fsm {
namespace {

// A ring of the eyeball about its optical axis: the angle from the axis, the colour, and the
// material of the band between this ring and the previous one.
struct BallRing {
  float angle;
  glm::vec3 colour;
  Material band;
};

std::array<BallRing, 11> Rings(const EyeAnatomy& eye, const Identity& identity) {
  const Features& features = *identity.features;
  const Palette& palette = identity.palette;
  const float iris = std::asin(eye.iris_radius() / eye.radius());
  const float pupil = std::asin(eye.pupil_radius() / eye.radius());
  const glm::vec3 black = features.pupil_colour;
  const glm::vec3 limbus = features.limbus.dark * palette.iris;
  const glm::vec3 edge = glm::mix(limbus, palette.sclera, features.limbus.outside);
  const glm::vec3 pink = palette.sclera * features.white_behind;
  const auto of_iris = [&, rings = PairsOf(features.iris_rings)](std::size_t k) {
    return BallRing{glm::mix(pupil, iris, rings[k].x), palette.iris * rings[k].y, Material::kIris};
  };
  return {BallRing{pupil * 0.6f, black, Material::kPupil},
          BallRing{pupil, black, Material::kPupil},
          of_iris(0),
          of_iris(1),
          of_iris(2),
          BallRing{iris * 0.97f, limbus, Material::kIris},
          BallRing{iris * 1.04f, edge, Material::kSclera},
          BallRing{iris * 1.2f, palette.sclera, Material::kSclera},
          BallRing{0.85f, palette.sclera, Material::kSclera},
          BallRing{1.15f, pink, Material::kSclera},
          BallRing{1.55f, pink, Material::kSclera}};
}

}  // namespace

void BuildEyes(const EyeAnatomy& eye, const Identity& identity, MeshBuilder& mesh) {
  constexpr int kSegments = 22;
  const auto rings = Rings(eye, identity);
  const float fibres = identity.features->iris_fibres;
  for (const Side side : kSides) {
    const Bone bone = BoneOf(side);
    const glm::vec3 centre = eye.CentreOf(side);
    const auto point = [&](float angle, float around) {
      // The cornea is a smaller sphere through the limbus, whose pole protrudes from the ball.
      const float c = eye.CorneaCentre();
      const float cosine = std::cos(angle);
      const float dome =
          c * cosine + std::sqrt(std::max(0.0f, step::kCorneaRadius * step::kCorneaRadius -
                                                    c * c * (1 - cosine * cosine)));
      const float r = std::max(eye.radius(), dome);
      return centre + r * glm::vec3(std::sin(angle) * std::cos(around),
                                    std::sin(angle) * std::sin(around), std::cos(angle));
    };
    const std::uint32_t pole = mesh.Add(point(0, 0), rings[0].colour, 1, bone);
    std::array<std::uint32_t, kSegments> before{};
    before.fill(pole);
    for (std::size_t k = 0; k < rings.size(); ++k) {
      std::array<std::uint32_t, kSegments> now{};
      for (int s = 0; s < kSegments; ++s) {
        const float around = 2 * kPi * static_cast<float>(s) / kSegments;
        glm::vec3 colour = rings[k].colour;
        // The fibres of the iris are light and dark rays.
        if (k >= 2 && k <= 4)
          colour *= 1 + fibres * NoiseAt(side == Side::kRight ? -s : s, PaintStream::kIrisFibre,
                                         static_cast<int>(k / 2));
        now[static_cast<std::size_t>(s)] =
            mesh.Add(point(rings[k].angle, around), colour, 0.95f, bone);
      }
      for (std::size_t s = 0; s < kSegments; ++s) {
        const std::size_t next = (s + 1) % kSegments;
        mesh.Quad(rings[k].band, before[s], now[s], now[next], before[next]);
      }
      before = now;
    }
  }
}

}  // namespace fsm
