#include "face_fit/find/figure_finder.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace facefit {
namespace {

constexpr int kFigureSide = 256;

/// A picture as a network takes it, RGB 0..1, stretched to a square.
std::vector<float> Stretched(const fsm::Image& image, int pixels) {
  std::vector<float> input;
  input.reserve(static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels) * 3);
  const glm::vec2 step = glm::vec2(image.width, image.height) / static_cast<float>(pixels);
  const int n = std::clamp(static_cast<int>(std::ceil(std::max(step.x, step.y))), 1, 8);
  for (int y = 0; y < pixels; ++y) {
    for (int x = 0; x < pixels; ++x) {
      glm::vec3 sum(0);
      for (int k = 0; k < n * n; ++k) {
        const glm::vec2 within = (glm::vec2(k % n, k / n) + 0.5F) / static_cast<float>(n);
        sum += ColourAt(image, (glm::vec2(x, y) + within) * step);
      }
      sum /= 255.0F * static_cast<float>(n * n);
      for (int c = 0; c < 3; ++c) input.push_back(sum[c]);
    }
  }
  return input;
}

/// What the figure's network gave at a place of its square, 0..1 on both axes.
float Between(const std::vector<float>& part, glm::vec2 place) {
  const glm::vec2 at = glm::clamp(place * static_cast<float>(kFigureSide) - 0.5F, 0.0F,
                                  static_cast<float>(kFigureSide) - 1.001F);
  const auto cell =
      static_cast<std::size_t>(static_cast<int>(at.y) * kFigureSide + static_cast<int>(at.x));
  const glm::vec2 t = glm::fract(at);
  const float top = glm::mix(part[cell], part[cell + 1], t.x);
  const float bottom = glm::mix(part[cell + kFigureSide], part[cell + kFigureSide + 1], t.x);
  return glm::mix(top, bottom, t.y);
}

}  // namespace

void DoubtOneSided(const FoundFace& face, const fsm::Image& image, std::vector<float>& person) {
  const int width = image.width, height = image.height;
  constexpr std::size_t kForehead = 10, kChin = 152;
  const glm::vec2 top(face.points[kForehead]), chin(face.points[kChin]);
  if (glm::distance(top, chin) < 1) return;
  const glm::vec2 down = glm::normalize(chin - top), across(-down.y, down.x);
  const float near = 0.03F * glm::distance(top, chin);
  const auto unlike = [&](glm::vec2 p, glm::vec2 q) {
    float least = 1;
    for (int k = 0; k < 9; ++k) {
      const glm::vec2 beside = q + near * (glm::vec2(k % 3, k / 3) - 1.0F);
      least = std::min(least, glm::distance(ColourAt(image, p), ColourAt(image, beside)) / 255);
    }
    return least;
  };
  const std::vector<float> seen = person;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::vec2 p = glm::vec2(x, y) + 0.5F;
      if (glm::dot(p - chin, down) > 0) continue;
      const glm::vec2 q = p - 2 * glm::dot(p - chin, across) * across;
      if (q.x < 0 || q.y < 0 || q.x >= static_cast<float>(width) ||
          q.y >= static_cast<float>(height)) {
        continue;
      }
      const auto at = [width](glm::vec2 v) {
        return static_cast<std::size_t>(v.y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(v.x);
      };
      if (seen[at(p)] > 0.8F * seen[at(q)]) continue;
      const float alike = glm::smoothstep(0.3F, 0.05F, unlike(p, q));
      person[at(p)] = std::max(seen[at(p)], glm::mix(0.5F, 0.85F, alike) * seen[at(q)]);
    }
  }
}

std::vector<float> FindFigure(FaceNetworks& networks, const fsm::Image& image,
                              const FoundFace* face) {
  const glm::vec2 size(image.width, image.height);
  // The network takes the whole picture, stretched to a square.
  networks.figure.Run(Stretched(image, kFigureSide));
  const std::vector<float> whole(networks.figure.output(0).begin(),
                                 networks.figure.output(0).end());
  std::vector<float> near;
  Crop head;
  if (face) {
    glm::vec2 low(1e9F), high(-1e9F);
    for (const glm::vec3& p : face->points) {
      low = glm::min(low, glm::vec2(p));
      high = glm::max(high, glm::vec2(p));
    }
    const float face_side = std::max(high.x - low.x, high.y - low.y);
    head.side = std::min({2.3F * face_side, size.x, size.y});
    head.centre = glm::clamp(0.5F * (low + high) - glm::vec2(0, 0.1F * face_side),
                             glm::vec2(head.side / 2), size - head.side / 2);
    networks.figure.Run(head.Sample(image, kFigureSide, 0, 1));
    near.assign(networks.figure.output(0).begin(), networks.figure.output(0).end());
  }
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const glm::vec2 p = glm::vec2(x, y) + 0.5F;
      float person = Between(whole, p / size);
      if (face) {
        // The mean where both see well: what one of them doubts is looked at by its colours.
        const glm::vec2 at = head.FromPicture(p);
        const glm::vec2 off = glm::abs(at - 0.5F);
        const float part = 0.5F * glm::smoothstep(0.48F, 0.38F, std::max(off.x, off.y));
        if (part > 0) person = glm::mix(person, Between(near, at), part);
      }
      out.push_back(person);
    }
  }
  if (face) DoubtOneSided(*face, image, out);
  return out;
}

}  // namespace facefit
