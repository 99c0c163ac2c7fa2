#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

#include "face_fit/dress/dress.h"

namespace facefit {
namespace {

glm::vec3 Linear(glm::vec3 screen) {
  const glm::vec3 c = screen / 255.0F;
  return c * (c * (c * 0.305306F + 0.682171F) + 0.012523F);
}

/// Of cheeks, upper lip, forehead and chin: linear.
float SkinLight(const FoundFace& face, const fsm::Image& photo) {
  constexpr std::size_t kSkin[] = {50, 280, 205, 425, 151, 9, 199};
  float light = 0;
  for (const std::size_t i : kSkin) {
    light += Brightness(Linear(ColourAt(photo, face.points[i]))) / std::size(kSkin);
  }
  return light;
}

}  // namespace

float Outside(const FoundFace& face, std::span<const int> outline, glm::vec2 pixel) {
  bool inside = false;
  float nearest = 1e9F;
  const auto at = [&](std::size_t k) {
    return glm::vec2(face.points[static_cast<std::size_t>(outline[k])]);
  };
  for (std::size_t k = 0, j = outline.size() - 1; k < outline.size(); j = k++) {
    const glm::vec2 a = at(k), b = at(j), way = b - a;
    const float part =
        glm::clamp(glm::dot(pixel - a, way) / std::max(glm::dot(way, way), 1e-6F), 0.0F, 1.0F);
    nearest = std::min(nearest, glm::distance(pixel, a + part * way));
    if ((a.y > pixel.y) == (b.y > pixel.y)) continue;
    if (pixel.x < way.x * (pixel.y - a.y) / way.y + a.x) inside = !inside;
  }
  return inside ? -nearest : nearest;
}

std::array<fsm::EyeTransform, 2> EyesAtRest(const BaseHead& base, const Fit& fit) {
  constexpr float kKept = 0.5F;
  constexpr std::size_t kUpper = 4, kLower = 12;  // the lids' middles in EyeOutline
  fsm::HeadVertices posed;
  base.head->Evaluate(fit.expression.State(), posed);
  std::array<fsm::EyeTransform, 2> seats = fit.eyes;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto raised = [&](std::size_t k) {
      const auto point = static_cast<std::size_t>(EyeOutline(static_cast<int>(side))[k]);
      const MeshPlace& lid = base.places[point];
      return lid.On(posed.position).y - lid.On(base.rest.position).y;
    };
    seats[side].upper_mm += kKept * std::min(raised(kUpper), 0.0F);
    seats[side].lower_mm += kKept * std::max(raised(kLower), 0.0F);
  }
  return seats;
}

void SampleEyes(const FoundFace& face, const Fit& fit, const fsm::Image& photo,
                fsm::PhotoHead& set) {
  std::vector<glm::vec3> iris, white;
  for (int side = 0; side < 2; ++side) {
    const auto outline = EyeOutline(side);
    const glm::vec2 a(face.points[static_cast<std::size_t>(outline[0])]);
    const glm::vec2 b(face.points[static_cast<std::size_t>(outline[8])]);
    const float wide = glm::distance(a, b);
    const IrisRing& ring = fit.irises[static_cast<std::size_t>(side)];
    const float radius = ring.radius;
    const glm::vec2 centre = ring.centre;
    for (float y = -0.25F; y <= 0.25F; y += 0.02F) {
      for (float x = -0.5F; x <= 0.5F; x += 0.02F) {
        const glm::vec2 at = 0.5F * (a + b) + wide * glm::vec2(x, y);
        if (Outside(face, outline, at) > -0.05F * wide) continue;
        const float far = glm::distance(at, centre) / radius;
        const glm::vec3 colour = ColourAt(photo, at);
        if (far > 0.45F && far < 0.85F) iris.push_back(colour);
        if (far > 1.25F) white.push_back(colour);
      }
    }
  }
  const auto pick = [](std::vector<glm::vec3>& colours, float part, glm::vec3 otherwise) {
    if (colours.size() < 8) return otherwise;
    std::ranges::sort(colours, {}, Brightness);
    const auto middle = static_cast<std::size_t>(part * static_cast<float>(colours.size() - 1));
    const std::size_t first = middle < 3 ? 0 : middle - 3;
    glm::vec3 sum(0);
    for (std::size_t i = first; i < first + 7; ++i) sum += colours[std::min(i, colours.size() - 1)];
    return sum / 7.0F;
  };
  // Drawn, an iris is darker than its base colour on the mean, where it meets pupil and rim.
  // In weak light it keeps its hue: brightened channel by channel a brown one would turn grey.
  const glm::vec3 tint = Linear(pick(iris, 0.5F, glm::vec3(90, 70, 55))) * 1.35F;
  constexpr float kDarkest = 0.012F;
  set.iris_colour = glm::clamp(tint * std::max(1.0F, kDarkest / std::max(Brightness(tint), 1e-4F)),
                               0.0005F, 0.6F);
  // Whites are paler than what is seen of them, but have the hue of the light; and in whatever
  // shade they are not darker than a third of the skin beside them.
  glm::vec3 ball = Linear(pick(white, 0.6F, glm::vec3(190)));
  const float least = 0.36F * SkinLight(face, photo);
  ball = glm::mix(ball, glm::vec3(Brightness(ball)), 0.35F);
  ball *= std::max(1.0F, least / std::max(Brightness(ball), 1e-3F));
  set.white_colour = glm::clamp(ball, 0.04F, 0.8F);
  set.iris_size = fit.iris_size;
}

void SampleMouth(const FoundFace& face, const fsm::Image& photo, fsm::PhotoHead& set) {
  // Along the middle of the lower lip, where it is widest.
  constexpr std::pair<std::size_t, std::size_t> kLower[] = {
      {84, 87}, {17, 14}, {314, 317}, {181, 178}, {405, 402}};
  glm::vec3 lip(0);
  for (const auto& [outer, inner] : kLower) {
    const glm::vec2 at = 0.5F * (glm::vec2(face.points[outer]) + glm::vec2(face.points[inner]));
    lip += Linear(ColourAt(photo, at)) / static_cast<float>(std::size(kLower));
  }
  // Screen colours are squares of it there; the inner rim lies in shade.
  set.lip_colour = 0.5F * glm::pow(lip, glm::vec3(0.91F));
  const float light = SkinLight(face, photo);
  set.teeth = std::clamp(0.4F + 1.9F * light, 0.4F, 1.5F);
}

}  // namespace facefit
