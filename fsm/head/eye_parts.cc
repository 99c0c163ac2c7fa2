#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "fsm/head/paint.h"
#include "fsm/head/parts.h"

namespace fsm {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

// One ring of the ball about its optical axis: the angle from the axis, colour, and material of the
// band between it and the ring before.
struct Ring {
  float angle;
  glm::vec3 colour;
  Material band;
};

std::array<Ring, 15> Rings(const EyeAnatomy& eye) {
  const float iris = std::asin(eye.iris_radius() / eye.radius());
  const float pupil = std::asin(eye.pupil_radius() / eye.radius());
  const glm::vec3 black(0.006f, 0.005f, 0.005f);
  const glm::vec3 inner(0.20f, 0.105f, 0.045f);
  const glm::vec3 middle(0.12f, 0.062f, 0.030f);
  const glm::vec3 limbus(0.022f, 0.014f, 0.012f);
  const glm::vec3 edge = glm::mix(limbus, palette::kSclera, 0.45f);
  const glm::vec3 pink = palette::kSclera * glm::vec3(0.96f, 0.80f, 0.76f);
  return {Ring{pupil * 0.55f, black, Material::kPupil},
          Ring{pupil, black, Material::kPupil},
          Ring{pupil * 1.12f, inner * 0.6f, Material::kIris},
          Ring{glm::mix(pupil, iris, 0.32f), inner, Material::kIris},
          Ring{glm::mix(pupil, iris, 0.52f), inner * 0.9f, Material::kIris},
          Ring{glm::mix(pupil, iris, 0.70f), middle, Material::kIris},
          Ring{glm::mix(pupil, iris, 0.86f), middle * 0.65f, Material::kIris},
          Ring{iris * 0.96f, limbus, Material::kIris},
          Ring{iris * 1.03f, edge, Material::kSclera},
          Ring{iris * 1.14f, palette::kSclera, Material::kSclera},
          Ring{0.75f, palette::kSclera, Material::kSclera},
          Ring{0.98f, palette::kSclera, Material::kSclera},
          Ring{1.2f, pink, Material::kSclera},
          Ring{1.5f, pink, Material::kSclera},
          Ring{1.9f, pink, Material::kSclera}};
}

}  // namespace

void BuildEyes(const EyeAnatomy& eye, HeadMesh& mesh) {
  constexpr int kSegments = 28;
  const auto rings = Rings(eye);
  const float iris = std::asin(eye.iris_radius() / eye.radius());
  for (const int side : {-1, 1}) {
    const Bone bone = side < 0 ? Bone::kEyeRight : Bone::kEyeLeft;
    glm::vec3 centre = eye.centre();
    centre.x *= static_cast<float>(side);
    const auto point = [&](float angle, float around) {
      // The cornea stands out a little; more would push through the lids when the eye turns.
      const float bulge = 0.55f * SmoothStep(iris * 1.1f, 0, angle);
      const float r = eye.radius() + bulge;
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
        // Fibres of the iris: light and dark rays.
        if (k >= 3 && k <= 6) colour *= 1 + 0.28f * Grain(s * side, static_cast<int>(k / 2));
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

void BuildLashes(const EyeAnatomy& eye, HeadMesh& mesh) {
  // Each lid wears a strip that thickens outward: from some way off lashes are a dark line.
  constexpr int kSteps = 16;
  for (const int side : {-1, 1}) {
    for (const bool upper : {true, false}) {
      const auto first = static_cast<std::uint32_t>(mesh.position.size());
      for (int i = 0; i <= kSteps; ++i) {
        const float part = static_cast<float>(i) / kSteps;
        const float from = eye.inner_x() + (upper ? 1.0f : 9.0f);
        const float x = glm::mix(from, eye.outer_x() - 0.2f, part);
        const float angle = upper ? eye.UpperAngle(x) : eye.LowerAngle(x);
        const float ends = std::sin(kPi * std::min(1.0f, 0.08f + 0.92f * part));
        const float length =
            upper ? 0.35f + 2.3f * part * (0.3f + 0.7f * SmoothStep(1.06f, 0.75f, part))
                  : 0.25f * ends;
        const float root = eye.LidRadius(x) + 0.12f;
        const float lift = upper ? 0.30f : -0.2f;
        Flesh flesh = FleshAt({x * static_cast<float>(side), eye.centre().y}, 0, -43);
        flesh.eye = static_cast<std::int8_t>(side);
        (upper ? flesh.lid_upper : flesh.lid_lower) = 1;
        flesh.free = 0;
        const auto add = [&](glm::vec3 p) {
          p.x *= static_cast<float>(side);
          mesh.Add(p, upper ? palette::kLash : glm::mix(palette::kSkin, palette::kLash, 0.55f), 1,
                   Bone::kFlesh, flesh);
        };
        // Three points: inner edge of the lid, its outer edge, and the lashes' tips.
        const float thick = upper ? 0.012f + 0.022f * part : 0.006f;
        add(eye.OnLid(x, angle - (upper ? 0.012f : -0.012f), root - (upper ? 0.5f : 0.0f)));
        add(eye.OnLid(x, angle + (upper ? thick : -thick), root));
        glm::vec3 tip = eye.OnLid(x, angle + (upper ? thick + 0.02f : -thick - 0.02f), root);
        const glm::vec3 out(0.35f * part, std::sin(angle + lift), std::cos(angle + lift));
        tip += length * out + glm::vec3(0, upper ? 0.28f * length : -0.12f * length, 0);
        add(tip);
      }
      mesh.Grid(Material::kLash, first, kSteps + 1, 3, (side > 0) != upper);
    }
  }
}

void BuildBrows(const FaceSurface& surface, const MouthAnatomy& mouth, HeadMesh& mesh) {
  // The brow's middle line and half height over x: a thin strip, dense along its middle and fading
  // to skin at its edges. Hairs are streaks of colour that lean outward.
  const Curve middle({9, 16, 26, 36, 43, 50, 56},
                     {39.4f, 41.0f, 43.4f, 45.2f, 45.0f, 42.6f, 39.6f});
  const Curve half({9, 13, 20, 32, 42, 50, 56}, {2.4f, 3.1f, 3.2f, 2.8f, 2.1f, 1.3f, 0.5f});
  constexpr int kSteps = 46;
  constexpr std::array kAcross = {1.0f, 0.62f, 0.2f, -0.25f, -0.65f, -1.0f};
  constexpr std::array kDense = {0.0f, 0.7f, 1.0f, 1.0f, 0.7f, 0.0f};
  for (const int side : {-1, 1}) {
    const auto first = static_cast<std::uint32_t>(mesh.position.size());
    for (int i = 0; i <= kSteps; ++i) {
      const float x = glm::mix(9.0f, 56.0f, static_cast<float>(i) / kSteps);
      for (std::size_t k = 0; k < kAcross.size(); ++k) {
        const float lean = 1.2f * kAcross[k];
        const glm::vec2 at(x + lean, middle(x + lean) + half(x) * kAcross[k]);
        glm::vec2 domain;
        glm::vec3 p = surface.PointAt(at, domain);
        p += (0.22f + 0.4f * kDense[k]) * surface.Normal(domain);
        const float ends = SmoothStep(8.5f, 17, x) * SmoothStep(57, 48, x);
        const float dense =
            kDense[k] * (0.35f + 0.65f * ends) * (0.93f + 0.07f * Grain(i, static_cast<int>(k)));
        const glm::vec3 colour = glm::mix(palette::kSkin * 0.93f, palette::kBrow, dense);
        p.x *= static_cast<float>(side);
        mesh.Add(p, colour, 1, Bone::kFlesh,
                 FleshAt({domain.x * static_cast<float>(side), domain.y}, 0, mouth.LineY(0)));
      }
    }
    mesh.Grid(Material::kBrow, first, kSteps + 1, static_cast<int>(kAcross.size()), side > 0);
  }
}

}  // namespace fsm
