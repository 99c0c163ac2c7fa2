#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/dress/dress.h"

namespace facefit {
namespace {

float Brightness(glm::vec3 c) { return 0.3F * c.r + 0.5F * c.g + 0.2F * c.b; }

glm::vec3 Linear(glm::vec3 screen) {
  const glm::vec3 c = screen / 255.0F;
  return c * (c * (c * 0.305306F + 0.682171F) + 0.012523F);
}

}  // namespace

bool Within(const FoundFace& face, std::span<const int> outline, float shrunk, glm::vec2 pixel) {
  glm::vec2 middle(0);
  for (const int i : outline) middle += glm::vec2(face.points[static_cast<std::size_t>(i)]);
  middle /= static_cast<float>(outline.size());
  bool inside = false;
  const auto at = [&](std::size_t k) {
    return glm::mix(middle, glm::vec2(face.points[static_cast<std::size_t>(outline[k])]), shrunk);
  };
  for (std::size_t k = 0, j = outline.size() - 1; k < outline.size(); j = k++) {
    const glm::vec2 a = at(k), b = at(j);
    if ((a.y > pixel.y) == (b.y > pixel.y)) continue;
    if (pixel.x < (b.x - a.x) * (pixel.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}

void SampleEyes(const FoundFace& face, const fsm::Image& photo, fsm::FaceSet& set) {
  std::vector<glm::vec3> iris, white;
  for (int side = 0; side < 2; ++side) {
    const auto outline = EyeOutline(side);
    const glm::vec2 a(face.points[static_cast<std::size_t>(outline[0])]);
    const glm::vec2 b(face.points[static_cast<std::size_t>(outline[8])]);
    const float wide = glm::distance(a, b);
    // The iris is the darkest place of its own size in the slit.
    const float radius = 0.19F * wide;
    glm::vec2 centre = 0.5F * (a + b);
    float darkest = 1e9F;
    for (int k = -6; k <= 6; ++k) {
      const glm::vec2 at = 0.5F * (a + b) + (b - a) * (static_cast<float>(k) * 0.025F);
      float sum = 0;
      for (int n = 0; n < 24; ++n) {
        const float t = static_cast<float>(n) * 0.2618F;
        sum += Brightness(
            ColourAt(photo, at + 0.6F * radius * glm::vec2(std::cos(t), 0.6F * std::sin(t))));
      }
      if (sum < darkest) {
        darkest = sum;
        centre = at;
      }
    }
    for (float y = -0.25F; y <= 0.25F; y += 0.02F) {
      for (float x = -0.5F; x <= 0.5F; x += 0.02F) {
        const glm::vec2 at = 0.5F * (a + b) + wide * glm::vec2(x, y);
        if (!Within(face, outline, 0.85F, at)) continue;
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
  // The shader's iris is darkest where it meets pupil and rim, so its base is brighter than its
  // mean.
  set.iris_colour =
      glm::clamp(Linear(pick(iris, 0.5F, glm::vec3(90, 70, 55))) * 1.5F, 0.015F, 0.45F);
  set.white_colour = glm::clamp(Linear(pick(white, 0.75F, glm::vec3(190))) * 0.9F, 0.16F, 0.72F);
}

}  // namespace facefit
