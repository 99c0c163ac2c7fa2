#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fsm/image/image.h"
#include "fsm/rig/pbr_material.h"
#include "fsm/rig/rig_data.h"

namespace fsm {

/// The material of a part of the mesh, by which the renderer chooses its shading.
enum class Material {
  kSkin,
  kLip,
  kSclera,
  kIris,
  kPupil,
  kTeeth,
  kGum,
  kTongue,
  kMouthInside,
  kLash,
  kHair,
  kCloth,
  kTextured,  ///< a sheet that shows the base colour only
  kShutLash,  ///< lashes of lids that wear a photo of open eyes; they appear as the lids shut
  kMatte      ///< plain-coloured parts (lashes, hair, clothes) beside skin that may show a picture
};

constexpr bool IsHair(Material material) {
  return material == Material::kHair || material == Material::kLash;
}

/// Tells whether a material is seen from both sides. Others are on closed surfaces, or on hair,
/// which has a lining where it hangs.
constexpr bool HasTwoSides(Material material) {
  using enum Material;
  return material == kLash || material == kShutLash || material == kMouthInside ||
         material == kMatte;
}

/// What one eye looks like. The cap of the eyeball in Material::kIris is the outer surface of the
/// bulging cornea; iris and pupil lie behind it and are drawn by parallax.
struct EyeGeometry {
  float ball_radius = 12;  ///< millimetres, as the others
  float iris_radius = 6;
  float pupil_radius = 2;
  glm::vec3 iris_colour{};                      ///< linear RGB
  glm::vec3 white_colour{0.66f, 0.64f, 0.62f};  ///< of the sclera
};

/// Where a photo shows an eye: squares as left, top, right, bottom in the photo, 0..1, v down.
struct EyePicture {
  glm::vec4 iris{};  ///< kIrisSpan radii of the iris to either side of its centre
  /// The area between the lids beside the iris, seen from the front: kBallSpan radii of the eyeball
  /// to either side of its centre.
  glm::vec4 ball{};
};
inline constexpr float kIrisSpan = 1.25f;
inline constexpr float kBallSpan = 1.4f;

/// How the hairs run at a vertex of hair, brows or lashes.
struct Strand {
  glm::vec3 along{0, -1, 0};  ///< from root to tip at rest; length 0..1: how sleek it is
  float density = 1;          ///< 1 = dense, 0 = no hairs: they thin out where a lock ends
  float across = 0;     ///< -1 and 1 at the sides of a lock, -0.5 and 0.5 of a hair, else 0..0.5
  glm::vec2 tile_mm{};  ///< position across and along the hairs, selecting hairs
};

/// How a lid's vertex looks when the lid is shut, on a head that wears a photo of open eyes. This
/// look replaces what the photo shows at TextureMaps::texcoord as the lid shuts.
struct ShutLid {
  std::uint32_t vertex;
  glm::vec3 colour;    ///< linear RGB
  float weight;        ///< opacity of the lid's colour, 0..1; lower where it blends into other skin
  glm::vec2 grain_at;  ///< texture coordinate of the skin that the lid takes its grain from
  float grain_light;   ///< mean screen brightness around it, 0..1
  glm::vec2 slide;     ///< from texcoord to the point of the photo that it moves to
};

/// A fine bent line that is painted into the skin's texture: a hair of brows, beard or hairline, or
/// a piece of a lid's fold. Its points are texture coordinates in HeadSurface::uv.
struct SkinStroke {
  glm::vec2 root, middle, tip;
  float width_mm;  ///< at the root; it tapers to a point
  glm::vec3 tint;  ///< factor on the skin's colour
};

/// The textures of a head: the photo of a person or those of a file.
struct TextureMaps {
  std::shared_ptr<const Image> base_colour;  ///< null: skin is painted and lit
  /// Laid out as `base_colour`; null where no material needs it. `normal_roughness_metal`: red and
  /// green are the normal's x and y (v up) about 128, blue and alpha factors on roughness and
  /// metal. `emission_openness`: the colour is the emission (toon: the shade), alpha the openness
  /// to light.
  std::shared_ptr<const Image> normal_roughness_metal, emission_openness;
  /// Per vertex where there is a base colour: its texture coordinate, 0..1, v down, and the weight
  /// of that texture in the colour, 0..1.
  std::vector<glm::vec2> texcoord;
  std::vector<float> weight;
};

/// Data that a head with the photo of a person has beside the picture.
struct Portrait {
  std::vector<ShutLid> shut_lids;
  /// The light in the photo as spherical harmonics: FaceLight::coefficients().
  glm::vec4 light{0, 0, 0, 1};
  /// Per vertex, 0..1: how much its shading changes as an expression turns it. May be empty.
  std::vector<float> relit;
  std::optional<Sided<EyePicture>> eyes;  ///< none if the photo shows no eyes: they are drawn
  /// Saturation of parts lit beside a photo, 0..1: our lamps are coloured, but a grey photo is not.
  float saturation = 1;
};

/// The part of a head that does not change while it moves.
struct HeadSurface {
  struct Part {
    Material material;
    std::uint32_t first_index;  ///< into `indices`
    std::uint32_t index_count;  ///< multiple of 3
    int pbr = -1;               ///< index into `pbr_materials`; -1: the shading of `material`
    bool two_sided = false;
  };
  std::vector<std::uint32_t> indices;  ///< triangles, counter-clockwise seen from outside
  std::vector<Part> parts;
  /// Returns the vertices of a part's triangles, three for each.
  std::span<const std::uint32_t> Corners(const Part& part) const {
    return std::span(indices).subspan(part.first_index, part.index_count);
  }
  std::vector<glm::vec3> albedo;  ///< per vertex, linear RGB 0..1
  std::vector<float> openness;    ///< per vertex, to ambient light: 0 = fully occluded, 1 = open
  std::vector<float> opacity;     ///< per vertex, 0..1; empty: all opaque
  /// Texture coordinates per vertex, 0..1, v up, of skin, lips and brows: the base identity's rest
  /// form unrolled about a vertical axis, with the front (60 degrees to either side) widened to
  /// 60 % of the width. May be empty.
  std::vector<glm::vec2> uv;
  std::vector<SkinStroke> skin_strokes;
  std::vector<Strand> strands;  ///< per vertex, meaningful on hair only; may be empty
  std::vector<PbrMaterial> pbr_materials;
  TextureMaps textures;
  Portrait portrait;
  Sided<EyeGeometry> eyes;
};

/// The view of a face that is meant to be seen in parallel projection, as those of the original:
/// the point at its centre and the distance from there to the edges of the longer side.
/// Millimetres.
struct ParallelView {
  glm::vec3 centre{0};
  float half_mm = 100;
};

/// Rest positions of named landmarks, in millimetres. See Head::Landmark.
using Landmarks = std::map<std::string, glm::vec3, std::less<>>;

/// One description of any head, wherever it comes from: how it looks and how it moves. The bakers
/// make it (head/: built-in heads and those of a photo; mesh/: heads of files); Head moves it and
/// the renderer draws it, and neither knows its origin. All arrays that are said to be per vertex
/// have the length of `rig.rest`, or are empty where that is allowed.
struct HeadAsset {
  HeadSurface surface;
  RigData rig;
  Landmarks landmarks;
  /// How the head is meant to be seen; none: in perspective from the camera.
  std::optional<ParallelView> view;
};

}  // namespace fsm
