#include "fsm/head/photo_surface.h"

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
glm::vec3 Wetter(const PhotoHead& photo_head, glm::vec3 lip, float share) {
  return lip * glm::mix(glm::vec3(1), photo_head.features->photo.mouth.wet_skin,
                        share * photo_head.saturation);
}

void NostrilsToSkin(std::span<const CageTag> tags, MeshBuilder& mesh) {
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
void RollLips(const PhotoHead& photo_head, std::span<const CageTag> tags, glm::vec3 lip_inside,
              HeadSurface& surface) {
  const auto& roll = photo_head.features->photo.lip_roll;
  const glm::vec3 lip = photo_head.lip_colour.value_or(lip_inside);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const CageTag& tag = tags[i];
    if (tag.red < 0 || tag.deep > 0.4f) continue;
    // The lower lip shows more of its inside.
    const float outward = (tag.deep > 0 ? -roll.deep * tag.deep : roll.red * tag.red) -
                          (tag.upper_lip < 0 ? roll.lower : 0.0f);
    if (outward >= roll.bleeds) continue;  // farther out, colours would bleed into the triangles
    // The corners stay together, so the photo's own line is visible there.
    const float at_corner = roll.corner.Ramp(tag.lip_column);
    // Beyond the end of the opening the lips stay together however wide it is.
    const float opens = tag.deep > 0 ? 1.0f : roll.opens.Ramp(tag.lip_column);
    const float wet = opens * SmoothStep(roll.photo.At(at_corner), roll.wet, outward);
    const glm::vec3 dry = glm::mix(surface.albedo[i], lip, roll.dry + (1 - roll.dry) * wet);
    // Light within the mouth has passed through flesh.
    const float inside = roll.inside.Ramp(outward);
    surface.albedo[i] = Wetter(photo_head, Wetter(photo_head, dry, 1), inside);
    surface.openness[i] = glm::mix(1.0f, roll.inside_light, inside);
    surface.textures.weight[i] = 1 - wet;
  }
}

/// Returns how much the photo's light follows the skin's normal: not around the eyes, where folds
/// exceed the change of light, and not beside the skin.
std::vector<float> RelitShares(const Features& features, const PhotoSkin& skin) {
  Sided<glm::vec3> eye;  // sum of x and y, and count
  for (std::size_t i = 0; i < skin.weights.size(); ++i) {
    const BakeWeights& weights = skin.weights[i];
    if (!weights.eye || weights.lid_upper + weights.lid_lower < features.photo_lid.held.margin)
      continue;
    eye[*weights.eye] += glm::vec3(glm::vec2(skin.open.position[i]), 1);
  }
  std::vector<float> shares(skin.weights.size());
  for (std::size_t i = 0; i < shares.size(); ++i) {
    float nearest = 1e9f;
    for (const glm::vec3 e : {eye.right, eye.left}) {
      const glm::vec2 middle = glm::vec2(e) / std::max(e.z, 1.0f);
      nearest = std::min(nearest, glm::distance(glm::vec2(skin.open.position[i]), middle));
    }
    shares[i] = features.photo.relit_from_eye.Ramp(nearest);
  }
  return shares;
}

/// Lashes become thin and pale with age, for which creases are the evidence.
void ThinLashes(const PhotoHead& photo_head, HeadSurface& surface) {
  const auto& lashes = photo_head.features->photo.shut_lashes;
  const glm::vec3 colour = glm::mix(lashes.grey, lashes.colour, photo_head.saturation);
  for (const auto& part : surface.parts) {
    if (part.material != Material::kShutLash) continue;
    const auto corners = surface.Corners(part);
    for (const std::uint32_t v : std::set<std::uint32_t>(corners.begin(), corners.end())) {
      surface.opacity[v] *= 1 - lashes.lost * photo_head.lined;
      surface.albedo[v] = colour;
    }
  }
}

/// Returns the sheet's weight of the jaw: almost 1 beside the chin and the jaw line, so that
/// nothing comes out from behind them; farther down skin and clothes are compressed.
float JawShare(const PhotoHead& photo_head, glm::vec3 p) {
  const auto& sheet = photo_head.features->photo.sheet;
  const float line = photo_head.skin_bottom_y + sheet.chin + sheet.chin_round * p.x * p.x;
  return sheet.jaw * (line + sheet.jaw_above).Ramp(p.y) * (line + sheet.jaw_below).Ramp(p.y) *
         sheet.jaw_aside.Ramp(std::abs(p.x));
}

/// Returns the opacity of skin over the sheet, which shows the same beside it: skin fades where the
/// cameras saw it at a grazing angle.
float SeenSkin(const PhotoHead& photo_head, glm::vec3 p, glm::vec3 normal) {
  const auto& seen = photo_head.features->photo.skin;
  const float above = p.y - photo_head.skin_bottom_y;
  // Within the face all skin stays: lids and nostrils face all directions.
  if (p.z > seen.face_z && above > seen.face_above) return 1;
  float faces = glm::dot(normal, photo_head.seen_from);
  for (const glm::vec3 camera : photo_head.also_seen)
    faces = std::max(faces, glm::dot(normal, camera));
  // Behind the chin skin stays opaque: it covers the sheet's underside, visible from the side.
  const float chin = seen.chin_above.Ramp(above) * seen.chin_aside.Ramp(std::abs(p.x)) *
                     seen.chin_down.Ramp(normal.y);
  const float line = NeckFrontZ(above);
  const float face = seen.faces.Ramp(faces) * (line + seen.before_neck).Ramp(p.z);
  return std::max(face, chin) * seen.ends.Ramp(above);
}

}  // namespace

void CopyColours(const PhotoHead& photo_head, Palette& palette) {
  const auto& mouth = photo_head.features->photo.mouth;
  palette.iris = photo_head.iris_colour;
  palette.sclera = photo_head.white_colour;
  Desaturate(palette, photo_head.saturation);
  if (photo_head.lip_colour) {
    // Where the lips roll inward the mouth is painted, beginning in their colour.
    palette.lip_inside = *photo_head.lip_colour / mouth.lips_light;
    palette.mouth = mouth.light * Wetter(photo_head, palette.lip_inside, mouth.wet);
  }
  // Teeth are in light whose hue the sclera shows. It comes from the front, where the
  // photographer's lamp is, and reaches into the mouth.
  const glm::vec3 white = photo_head.white_colour;
  palette.tooth *=
      mouth.teeth * photo_head.teeth *
      glm::mix(glm::vec3(1), white / std::max({white.r, white.g, white.b, 1e-3f}), mouth.teeth_hue);
  palette.tongue *= mouth.tongue * photo_head.teeth;
}

float NeckFrontZ(float above_bottom_mm) { return 30 * SmoothStep(48, 36, above_bottom_mm); }

void AddPhotoSheet(const PhotoHead& photo_head, MeshBuilder& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (const auto& vertex : photo_head.sheet) {
    BakeWeights weights{.follows = BakeWeights::Follows::kNothing};  // it is in its final place
    weights.skin.free = 0;
    weights.skin.domain = vertex.position;
    // The shoulders follow a turning head a little.
    weights.skin.neck =
        glm::mix(photo_head.features->photo.sheet.shoulders, 1.0f, NeckWeight(vertex.position.y));
    weights.skin.jaw = JawShare(photo_head, vertex.position);
    mesh.Add(vertex.position, glm::vec3(0.3f), 1, Bone::kSkin, weights);
  }
  const auto& t = photo_head.sheet_triangles;
  for (std::size_t i = 0; i + 2 < t.size(); i += 3) {
    mesh.Triangle(Material::kTextured, first + t[i], first + t[i + 1], first + t[i + 2]);
  }
}

void FreezeSkinBehindGlasses(const Features& features, glm::vec2 eye, std::size_t skin_count,
                             MeshBuilder& mesh) {
  const auto& lens = features.photo.lens;
  for (std::size_t i = 0; i < skin_count; ++i) {
    BakeWeights& weights = mesh.weights[i];
    const float up = weights.skin.domain.y - eye.y;
    const glm::vec2 offset((std::abs(weights.skin.domain.x) - eye.x) / lens.aside,
                           up / (up > 0 ? lens.up : lens.down));
    weights.skin.free *= lens.holds.Ramp(glm::length(offset));
  }
}

void RemoveUnseenSkin(const PhotoHead& photo_head, std::span<const CageTag> tags,
                      MeshBuilder& mesh) {
  NostrilsToSkin(tags, mesh);
  for (auto& batch : mesh.batches) {
    if (batch.material != Material::kSkin) continue;
    const auto normal = Normals(batch.indices, mesh.position, mesh.position.size());
    for (const std::uint32_t v : batch.indices) {
      mesh.opacity[v] = SeenSkin(photo_head, mesh.position[v], normal[v]);
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

void ApplyPhoto(const PhotoHead& photo_head, const PhotoSkin& skin, glm::vec3 lip_inside,
                HeadSurface& surface) {
  const std::size_t skin_count = skin.weights.size();
  surface.textures.base_colour = photo_head.atlas;
  surface.portrait.saturation = photo_head.saturation;
  surface.portrait.eyes = photo_head.eye_pictures;
  surface.textures.texcoord.resize(surface.uv.size());
  surface.textures.weight.resize(surface.uv.size());
  for (std::size_t i = 0; i < skin_count; ++i) {
    surface.textures.texcoord[i] =
        glm::mix(photo_head.skin_low, photo_head.skin_high, surface.uv[i]);
  }
  for (std::size_t i = 0; i < photo_head.sheet.size(); ++i) {
    surface.textures.texcoord[skin_count + i] = photo_head.sheet[i].texcoord;
  }
  std::fill_n(surface.textures.weight.begin(), skin_count + photo_head.sheet.size(), 1.0f);
  // The photo ends at the lips; the inside of the mouth is painted.
  for (const auto& part : surface.parts) {
    if (part.material != Material::kMouthInside) continue;
    for (const std::uint32_t v : surface.Corners(part)) surface.textures.weight[v] = 0;
  }
  // Where paint begins, it blends from the photo's colour.
  for (std::size_t i = 0; i < skin_count; ++i) {
    if (surface.textures.weight[i] <= 0) continue;
    surface.albedo[i] = FromScreen(PhotoColour(*photo_head.atlas, surface.textures.texcoord[i]));
    surface.openness[i] = 1;
  }
  ThinLashes(photo_head, surface);
  RollLips(photo_head, skin.tags, lip_inside, surface);
  const PhotoMapping mapping{*photo_head.atlas, surface.textures.texcoord, surface.textures.weight};
  const FaceLight light = FitFaceLight(mapping, skin.open);
  surface.portrait.light = light.coefficients();
  surface.portrait.relit = RelitShares(*photo_head.features, skin);
  surface.portrait.relit.resize(surface.uv.size());
  surface.portrait.shut_lids =
      PaintLids(mapping, skin, photo_head.glasses, *photo_head.features, light);
  for (const ShutLid& lid : surface.portrait.shut_lids) surface.textures.weight[lid.vertex] = 1;
}

}  // namespace fsm
