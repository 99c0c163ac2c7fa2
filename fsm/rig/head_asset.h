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
#include <utility>
#include <vector>

#include "fsm/image/image.h"
#include "fsm/rig/pbr_material.h"
#include "fsm/rig/rig_data.h"

namespace fsm {

/// What a part of the mesh is made of; the renderer chooses its shading by it.
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
  kPhoto,     ///< a sheet that shows the photo and nothing else
  kShutLash,  ///< of lids that wear a photo of open eyes: seen as they shut
  kMatte  ///< what has a plain colour beside skin that may show a picture: lashes, hair, clothes
};

constexpr bool IsHair(Material material) {
  return material == Material::kHair || material == Material::kLash;
}

/// One eye at rest. The cap of the ball in Material::kIris is the cornea's outer surface, which
/// bulges; iris and pupil lie behind it and are drawn by parallax.
struct EyeGeometry {
  glm::vec3 centre{};  ///< of the ball, millimetres
  float ball_radius = 12;
  float iris_radius = 6;
  float pupil_radius = 2;
  glm::vec3 iris_colour{};                      ///< linear RGB
  glm::vec3 white_colour{0.66f, 0.64f, 0.62f};  ///< of the sclera
};

/// Where a photo shows an eye: squares as left, top, right and bottom, 0..1, v down.
struct EyePicture {
  glm::vec4 iris{};  ///< to kIrisSpan radii of the iris from its middle
  /// What lies between the lids beside the iris, from the front: to kBallSpan radii of the ball
  /// from its centre.
  glm::vec4 ball{};
};
inline constexpr float kIrisSpan = 1.25f;
inline constexpr float kBallSpan = 1.4f;

/// How hairs run at a vertex of hair, brows or lashes.
struct Strand {
  glm::vec3 along{0, -1, 0};  ///< from root to tip at rest; its length, 0..1: how sleek it is
  float density = 1;          ///< 1 = dense, 0 = none: hairs thin out where a lock ends
  float across = 0;           ///< -1..1 over the width of a lock whose sides fray, 0 elsewhere
  glm::vec2 tile_mm{};        ///< across and along the hairs: which of them are seen here
};

/// What a vertex of a lid looks like when the lid is shut, on a head that wears a photo of open
/// eyes: what the photo shows at TextureMaps::texcoord gives way to it as the lid shuts.
struct ShutLid {
  std::uint32_t vertex;
  glm::vec3 colour;    ///< linear RGB
  float weight;        ///< opacity of the lid's colour, 0..1: less where it blends into other skin
  glm::vec2 grain_at;  ///< texture coordinate of the skin whose grain the lid takes
  float grain_light;   ///< mean screen brightness around it, 0..1
  glm::vec2 slide;     ///< from the vertex's texcoord to where in the photo it comes to lie
};

/// A fine hair that lies on the skin and is painted into its texture: of the brows. Places are
/// those of HeadTopology::uv.
struct SkinHair {
  glm::vec2 root, middle, tip;
  float width_mm;  ///< at the root; it ends in a point
  glm::vec3 tint;  ///< factor on the skin's colour
};

/// Where the lips part, by vertices: light comes into the mouth there. Teeth bound it further in.
struct MouthSlit {
  /// Edges of the upper and the lower lip, from -x to +x, corners excluded; may be empty.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;
  std::uint32_t corner_right = 0, corner_left = 0;     ///< the agent's
  std::uint32_t upper_incisor = 0, lower_incisor = 0;  ///< at their edges
  std::uint32_t upper_root = 0;                        ///< right above upper_incisor
};

/// The picture on a head: the photo of a person, or what a file has.
struct TextureMaps {
  std::shared_ptr<const Image> image;  ///< nothing: skin is painted and lit
  /// Laid out as the image; nothing where no material needs it. Of `normal_map` red and green are
  /// the normal's x and y (v up) about 128, blue and alpha factors of roughness and metal; of
  /// `emissive_map` the colour is that of what glows (toon: of the shade), alpha how open to light.
  std::shared_ptr<const Image> normal_map, emissive_map;
  /// Per vertex where there is an image: its place there, 0..1, v down, and the image's part in the
  /// colour, 0..1.
  std::vector<glm::vec2> texcoord;
  std::vector<float> weight;
};

/// Data of a head with the photo of a person, beside the picture.
struct Portrait {
  std::vector<ShutLid> shut_lids;
  /// The light in the photo, as FaceLight::coefficients().
  glm::vec4 light{0, 0, 0, 1};
  /// Per vertex, 0..1: how much its light changes as an expression turns it. May be empty.
  std::vector<float> relit;
  std::optional<Sided<EyePicture>> eyes;  ///< if the photo shows them; else they are drawn
  /// Saturation of what is lit beside a photo, 0..1: our lamps are coloured, a grey photo is not.
  float saturation = 1;
};

/// The part of a head that never changes while it moves.
struct HeadTopology {
  struct Part {
    Material material;
    std::uint32_t first_index;  ///< into `indices`
    std::uint32_t index_count;  ///< multiple of 3
    int pbr = -1;               ///< into `pbr_materials`; -1: as its material is
    bool two_sided = false;
  };
  std::vector<std::uint32_t> indices;  ///< triangles, counter-clockwise seen from outside
  std::vector<Part> parts;
  /// The vertices of a part's triangles, three for each.
  std::span<const std::uint32_t> Corners(const Part& part) const {
    return std::span(indices).subspan(part.first_index, part.index_count);
  }
  std::vector<glm::vec3> albedo;  ///< per vertex, linear RGB 0..1
  std::vector<float> openness;    ///< per vertex, to light: 0 = fully shut off, 1 = open
  std::vector<float> opacity;     ///< per vertex, 0..1: how much it hides; empty: all
  /// Per vertex, 0..1, v up: the base identity's rest form unrolled about a vertical axis, with the
  /// front (60 degrees to either side) widened to 60 % of the width. For skin, lips and brows; may
  /// be empty.
  std::vector<glm::vec2> uv;
  std::vector<SkinHair> skin_hairs;
  std::vector<Strand> strands;  ///< per vertex, meaningful where there is hair; may be empty
  std::vector<PbrMaterial> pbr_materials;
  TextureMaps textures;
  Portrait portrait;
  MouthSlit mouth;
  Sided<EyeGeometry> eyes;
};

/// A window onto a face that is meant to be seen without perspective, as those of the original:
/// what its middle shows, and how far it is from there to the edges of its longer side.
/// Millimetres.
struct ParallelView {
  glm::vec3 centre{0};
  float half_mm = 100;
};

/// Where a head has what the tables call by name, at rest; millimetres. See Head::Landmark.
using Landmarks = std::map<std::string, glm::vec3, std::less<>>;

/// One description of any head, wherever it comes from: how it looks and how it moves. The bakers
/// make it (head/: built-in heads and those of a photo; mesh/: heads of files); Head moves it, and
/// the renderer draws it. Neither knows where it came from. All arrays that are said to be per
/// vertex have the length of `rig.rest`, or are empty where that is allowed.
struct HeadAsset {
  HeadTopology topology;
  RigData rig;
  Landmarks landmarks;
  /// How the head is meant to be seen; nothing: in perspective, as the camera stands.
  std::optional<ParallelView> view;
};

}  // namespace fsm
