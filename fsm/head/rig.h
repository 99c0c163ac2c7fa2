#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/head/head.h"

namespace fsm {

/// What carries a vertex. Flesh follows the action units, the mouth, the lids and the jaw; the
/// others move as rigid bodies (the tongue bends a little).
enum class Bone : std::uint8_t { kSkin, kSkull, kJaw, kTongue, kEyeLeft, kEyeRight };

/// How a flesh vertex takes part in the motions; all weights 0..1.
struct SkinWeights {
  glm::vec2 domain{};        ///< where on the face: nearly (x, y) at rest, see FaceSurface
  float above_mouth = 0.5f;  ///< 1 = moves with the upper lip's side, 0 = with the lower's
  float jaw = 0;
  float neck = 1;       ///< part of the head's turn it makes
  float free = 1;       ///< part of the action units' motion it takes (lid rims take none)
  std::int8_t eye = 0;  ///< -1 right, +1 left, 0 none
  float lid_upper = 0;
  float lid_lower = 0;
  std::int16_t lip_column = -1;  ///< index of the pair of seam vertices that corrects it
  bool by_teeth = false;         ///< may touch the teeth: held off them
  float lip_weight = 0;          ///< > 0 upper lip, < 0 lower lip
};

/// A mesh under construction: vertices with their paint and their rig, triangles by material.
struct HeadMesh {
  std::vector<glm::vec3> position;
  std::vector<glm::vec3> albedo;
  std::vector<float> occlusion;
  std::vector<Bone> bone;
  std::vector<SkinWeights> flesh;  ///< meaningful where bone is kSkin
  std::vector<Strand> strands;     ///< meaningful where there is hair

  struct Batch {
    Material material;
    std::vector<std::uint32_t> indices;
    int finish = -1;  ///< see HeadTopology::Part, two_sided too
    bool two_sided = false;
  };
  std::vector<Batch> batches;

  std::uint32_t Add(glm::vec3 p, glm::vec3 colour, float open, Bone b, const SkinWeights& f = {});
  /// A quad with corners counter-clockwise from outside; degenerate halves are left out.
  void Quad(Material material, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
  void Triangle(Material material, std::uint32_t a, std::uint32_t b, std::uint32_t c);
  /// Quads over a grid of `rows` x `columns` vertices that begin at `first`, row after row.
  void Grid(Material material, std::uint32_t first, int rows, int columns, bool flip = false);
};

/// Fills the weights that follow from a place on the face alone. `side`: +1 above the mouth's slit,
/// -1 below it, 0 where the cheek joins both.
SkinWeights SkinWeightsAt(glm::vec2 domain, int side, float mouth_line_y);

/// Adds the normals of triangles, by their areas, to those of their corners, and makes them unit.
void Accumulate(std::span<const std::uint32_t> triangles, std::span<const glm::vec3> position,
                std::span<glm::vec3> normal);
/// Likewise from nothing, of `count` vertices.
std::vector<glm::vec3> Normals(std::span<const std::uint32_t> triangles,
                               std::span<const glm::vec3> position, std::size_t count);

}  // namespace fsm
