#include "fsm/render/head_description.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

namespace fsm {
namespace {

/// Returns the photo's resolution on surfaces that face the viewer, as seen from the front: the
/// square root of texels per square millimetre.
float TexelsPerMm(const HeadSurface& surface, const HeadVertices& rest) {
  const Image* image = surface.textures.base_colour.get();
  const auto& texcoord = surface.textures.texcoord;
  const auto& weight = surface.textures.weight;
  if (!image || texcoord.empty()) return 0;
  const glm::vec2 size(image->width, image->height);
  double texels = 0, area = 0;
  for (std::size_t k = 0; k + 2 < surface.indices.size(); k += 3) {
    const auto* t = &surface.indices[k];
    if (std::min({weight[t[0]], weight[t[1]], weight[t[2]]}) <= 0) continue;
    const glm::vec2 a = size * (texcoord[t[1]] - texcoord[t[0]]);
    const glm::vec2 b = size * (texcoord[t[2]] - texcoord[t[0]]);
    const glm::vec2 c(rest.position[t[1]] - rest.position[t[0]]);
    const glm::vec2 d(rest.position[t[2]] - rest.position[t[0]]);
    const float seen = c.x * d.y - c.y * d.x;
    if (seen <= 0) continue;
    texels += std::abs(a.x * b.y - a.y * b.x);
    area += seen;
  }
  return area > 0 ? static_cast<float>(std::sqrt(texels / area)) : 0.0f;
}

}  // namespace

HeadDescription::HeadDescription(const Head& head, const HeadVertices& rest,
                                 const Appearance& appearance)
    : surface(head.shared_surface()),
      eyes(*surface, rest),
      shadows(*surface, rest),
      mouth(head.mouth()),
      photo_texels_per_mm(TexelsPerMm(*surface, rest)) {
  if (eyes.found()) resting_eyes = eyes.Measure(rest);
  const auto landmarks = FaceLandmarks::Find(head);
  if (!landmarks) return;
  chin_y = landmarks->gnathion.y;
  if (surface->uv.size() == rest.position.size()) {
    creases = WeighCreases(rest, *landmarks, appearance);
    skin = SkinPainting(surface, rest, *landmarks, appearance);
  }
}

std::vector<std::uint32_t> HeadDescription::MeasuredVertices() const {
  std::vector<std::uint32_t> vertices;
  eyes.AppendVertices(vertices);
  shadows.AppendVertices(vertices);
  mouth.AppendVertices(vertices);
  return vertices;
}

}  // namespace fsm
