#include "fsm/head/photo_wear.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <set>
#include <utility>
#include <vector>

#include "fsm/base/smooth_step.h"

namespace fsm {
namespace {

/// Desaturates the colours of parts that a photo does not show.
void Desaturate(Palette& palette, float saturation) {
  for (glm::vec3* colour : {&palette.tooth, &palette.lip_inside, &palette.lid_rim, &palette.mouth,
                            &palette.tongue, &palette.gum}) {
    *colour =
        glm::mix(glm::vec3(glm::dot(*colour, glm::vec3(0.3f, 0.6f, 0.1f))), *colour, saturation);
  }
}

/// Reddens lips where they are wet and thin-skinned, as far as the photo has colours.
glm::vec3 Wetter(const PhotoHead& head, glm::vec3 lip, float part) {
  return lip * glm::mix(glm::vec3(1), head.UsedFeatures().photo_lips_wet, part * head.saturation);
}

void DarkenNostrils(std::span<const CageTag> tags, HeadMesh& mesh) {
  std::vector<std::uint32_t> nostrils;
  for (auto& batch : mesh.batches) {
    if (batch.material != Material::kMouthInside) continue;
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i + 2 < batch.indices.size(); i += 3) {
      const std::uint32_t* corner = &batch.indices[i];
      const bool nose = std::any_of(
          corner, corner + 3, [&](std::uint32_t v) { return v < tags.size() && tags[v].hole > 0; });
      (nose ? nostrils : kept).insert((nose ? nostrils : kept).end(), corner, corner + 3);
    }
    batch.indices = std::move(kept);
  }
  for (std::size_t i = 0; i + 2 < nostrils.size(); i += 3) {
    mesh.Triangle(Material::kSkin, nostrils[i], nostrils[i + 1], nostrils[i + 2]);
  }
}

/// A photo of a closed mouth does not show where the lips roll inward. As they part, their own
/// colour becomes redder and darker from the line where they met, until it is that of the lining.
void RollLips(const PhotoHead& head, std::span<const CageTag> tags, glm::vec3 lip_inside,
              HeadTopology& topology) {
  constexpr float kRed = 8, kDeep = 14;         // scale of the tags in millimetres
  constexpr float kPhoto = 1.8f, kWet = -2.0f;  // outward of the line: photo only, paint only
  const glm::vec3 lip = head.lip_colour.value_or(lip_inside);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const CageTag& tag = tags[i];
    if (tag.red < 0 || tag.deep > 0.4f) continue;
    // The lower lip shows more of its inside.
    const float outward =
        (tag.deep > 0 ? -kDeep * tag.deep : kRed * tag.red) - (tag.lip_side < 0 ? 0.9f : 0.0f);
    if (outward >= kPhoto + 4) continue;  // farther out, colours would bleed into the triangles
    // The corners stay together, so the photo's own line is visible there.
    const float at_corner = SmoothStep(4.0f, 5.2f, tag.lip_column);
    // Beyond the end of the opening the lips stay together however wide it is.
    const float opens = tag.deep > 0 ? 1.0f : SmoothStep(5.5f, 4.7f, tag.lip_column);
    const float wet = opens * SmoothStep(glm::mix(kPhoto, 1.3f, at_corner), kWet, outward);
    const glm::vec3 dry = glm::mix(topology.albedo[i], lip, 0.3f + 0.7f * wet);
    // Light within the mouth has passed through flesh.
    const float inside = SmoothStep(0.5f, -4.0f, outward);
    topology.albedo[i] = Wetter(head, Wetter(head, dry, 1), inside);
    topology.openness[i] = glm::mix(1.0f, 0.4f, inside);
    topology.textures.weight[i] = 1 - wet;
  }
}

/// Returns how much the photo's light follows the skin's normal: not around the eyes, where folds
/// exceed the change of light, and not beside the skin.
std::vector<float> RelitParts(const PhotoSkin& skin) {
  constexpr float kNone = 14, kAll = 26;  // millimetres from the centre of an eye
  Sided<glm::vec3> eye;                   // sum of x and y, and count
  for (std::size_t i = 0; i < skin.weights.size(); ++i) {
    const BakeWeights& weights = skin.weights[i];
    if (!weights.eye || weights.lid_upper + weights.lid_lower < 0.95f) continue;
    eye[*weights.eye] += glm::vec3(glm::vec2(skin.open.position[i]), 1);
  }
  std::vector<float> parts(skin.weights.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    float nearest = 1e9f;
    for (const glm::vec3 e : {eye.right, eye.left}) {
      const glm::vec2 middle = glm::vec2(e) / std::max(e.z, 1.0f);
      nearest = std::min(nearest, glm::distance(glm::vec2(skin.open.position[i]), middle));
    }
    parts[i] = SmoothStep(kNone, kAll, nearest);
  }
  return parts;
}

/// Lashes become thin and pale with age, for which creases are the evidence.
void ThinLashes(const PhotoHead& head, HeadTopology& topology) {
  constexpr float kLost = 0.5f;
  const Features& features = head.UsedFeatures();
  const glm::vec3 colour =
      glm::mix(features.photo_lash_grey, features.photo_lash_colour, head.saturation);
  for (const auto& part : topology.parts) {
    if (part.material != Material::kShutLash) continue;
    const auto corners = topology.Corners(part);
    for (const std::uint32_t v : std::set<std::uint32_t>(corners.begin(), corners.end())) {
      topology.opacity[v] *= 1 - kLost * head.lined;
      topology.albedo[v] = colour;
    }
  }
}

/// Returns the sheet's weight of the jaw: almost 1 beside the chin and the jaw line, so that
/// nothing comes out from behind them; farther down skin and clothes are compressed.
float JawPart(glm::vec3 p, float skin_bottom) {
  constexpr float kMost = 0.9f, kChin = 8;  // millimetres above the skin's bottom
  const float line = skin_bottom + kChin + 0.012f * p.x * p.x;
  return kMost * SmoothStep(line + 16, line + 2, p.y) * SmoothStep(line - 62, line - 4, p.y) *
         SmoothStep(78, 46, std::abs(p.x));
}

/// Returns the opacity of skin over the sheet, which shows the same beside it: skin fades where the
/// cameras saw it at a grazing angle.
float SeenSkin(const PhotoHead& head, glm::vec3 p, glm::vec3 normal) {
  const float above = p.y - head.skin_bottom_y;
  // Within the face all skin stays: lids and nostrils face all directions.
  if (p.z > 45 && above > 14) return 1;
  float faces = glm::dot(normal, head.seen_from);
  for (const glm::vec3 camera : head.also_seen) faces = std::max(faces, glm::dot(normal, camera));
  // Behind the chin skin stays opaque: it covers the sheet's underside, visible from the side.
  const float chin = SmoothStep(60, 45, above) * SmoothStep(40, 25, std::abs(p.x)) *
                     SmoothStep(0.0f, -0.25f, normal.y);
  const float line = JawLine(above);
  const float face = SmoothStep(0.12f, 0.36f, faces) * SmoothStep(line - 2, line + 10, p.z);
  return std::max(face, chin) * SmoothStep(0, 6, above);
}

}  // namespace

void TakeColours(const PhotoHead& head, Palette& palette) {
  const Features& features = head.UsedFeatures();
  palette.iris = head.iris_colour;
  palette.sclera = head.white_colour;
  Desaturate(palette, head.saturation);
  if (head.lip_colour) {
    // Where the lips roll inward the mouth is painted, beginning in their colour.
    palette.lip_inside = *head.lip_colour / features.photo_lips_light;
    palette.mouth = features.photo_mouth * Wetter(head, palette.lip_inside, 0.5f);
  }
  // Teeth are in light whose hue the sclera shows. It comes from the front, where the
  // photographer's lamp is, and reaches into the mouth.
  const glm::vec3 white = head.white_colour;
  palette.tooth *= features.photo_teeth * head.teeth *
                   glm::mix(glm::vec3(1), white / std::max({white.r, white.g, white.b, 1e-3f}),
                            features.photo_teeth_hue);
  palette.tongue *= features.photo_tongue * head.teeth;
}

float JawLine(float above_bottom) { return 30 * SmoothStep(48, 36, above_bottom); }

void AddPhotoSheet(const PhotoHead& head, HeadMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (const auto& vertex : head.sheet) {
    BakeWeights weights{.follows = BakeWeights::Follows::kNothing};  // it is in its final place
    weights.skin.free = 0;
    weights.skin.domain = vertex.position;
    // The shoulders follow a turning head a little.
    constexpr float kFollows = 0.15f;
    weights.skin.neck = glm::mix(kFollows, 1.0f, SmoothStep(-166, -98, vertex.position.y));
    weights.skin.jaw = JawPart(vertex.position, head.skin_bottom_y);
    mesh.Add(vertex.position, glm::vec3(0.3f), 1, Bone::kSkin, weights);
  }
  const auto& t = head.sheet_triangles;
  for (std::size_t i = 0; i + 2 < t.size(); i += 3) {
    mesh.Triangle(Material::kPhoto, first + t[i], first + t[i + 1], first + t[i + 2]);
  }
}

void HoldBehindGlasses(glm::vec2 eye, std::size_t skin_count, HeadMesh& mesh) {
  // Extent of a large lens with its rim from the eye, millimetres.
  constexpr float kAside = 37, kUp = 19, kDown = 29;
  for (std::size_t i = 0; i < skin_count; ++i) {
    BakeWeights& weights = mesh.weights[i];
    const float up = weights.skin.domain.y - eye.y;
    const glm::vec2 off((std::abs(weights.skin.domain.x) - eye.x) / kAside,
                        up / (up > 0 ? kUp : kDown));
    weights.skin.free *= SmoothStep(1, 1.35f, glm::length(off));
  }
}

void LeaveOutUnseen(const PhotoHead& head, std::span<const CageTag> tags, HeadMesh& mesh) {
  DarkenNostrils(tags, mesh);
  for (auto& batch : mesh.batches) {
    if (batch.material != Material::kSkin) continue;
    const auto normal = Normals(batch.indices, mesh.position, mesh.position.size());
    for (const std::uint32_t v : batch.indices) {
      mesh.opacity[v] = SeenSkin(head, mesh.position[v], normal[v]);
    }
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i + 2 < batch.indices.size(); i += 3) {
      const std::uint32_t* corner = &batch.indices[i];
      const bool seen =
          std::any_of(corner, corner + 3, [&](std::uint32_t v) { return mesh.opacity[v] > 0; });
      if (seen) kept.insert(kept.end(), corner, corner + 3);
    }
    batch.indices = std::move(kept);
  }
}

void WearPhoto(const PhotoHead& head, const PhotoSkin& skin, glm::vec3 lip_inside,
               HeadTopology& topology) {
  const std::size_t skin_count = skin.weights.size();
  topology.textures.image = head.photo;
  topology.portrait.saturation = head.saturation;
  topology.portrait.eyes = head.eye_pictures;
  topology.textures.texcoord.resize(topology.uv.size());
  topology.textures.weight.resize(topology.uv.size());
  for (std::size_t i = 0; i < skin_count; ++i) {
    topology.textures.texcoord[i] = glm::mix(head.skin_low, head.skin_high, topology.uv[i]);
  }
  for (std::size_t i = 0; i < head.sheet.size(); ++i) {
    topology.textures.texcoord[skin_count + i] = head.sheet[i].texcoord;
  }
  std::fill_n(topology.textures.weight.begin(), skin_count + head.sheet.size(), 1.0f);
  // The photo ends at the lips; the inside of the mouth is painted.
  for (const auto& part : topology.parts) {
    if (part.material != Material::kMouthInside) continue;
    for (const std::uint32_t v : topology.Corners(part)) topology.textures.weight[v] = 0;
  }
  // Where paint begins, it blends from the photo's colour.
  for (std::size_t i = 0; i < skin_count; ++i) {
    if (topology.textures.weight[i] <= 0) continue;
    topology.albedo[i] = FromScreen(PhotoColour(*head.photo, topology.textures.texcoord[i]));
    topology.openness[i] = 1;
  }
  ThinLashes(head, topology);
  RollLips(head, skin.tags, lip_inside, topology);
  const PhotoMapping mapping{*head.photo, topology.textures.texcoord, topology.textures.weight};
  const FaceLight light = FitFaceLight(mapping, skin.open);
  topology.portrait.light = light.coefficients();
  topology.portrait.relit = RelitParts(skin);
  topology.portrait.relit.resize(topology.uv.size());
  topology.portrait.shut_lids = PaintLids(mapping, skin, head.glasses, head.UsedFeatures(), light);
  for (const ShutLid& lid : topology.portrait.shut_lids) topology.textures.weight[lid.vertex] = 1;
}

}  // namespace fsm
