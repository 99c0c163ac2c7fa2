#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "fsm/rig/head_asset.h"
#include "fsm/rig/normals.h"
#include "fsm/rig/skin_weights.h"

namespace fsm {

/// The weights of a vertex while its head is made, and which lid, lip and teeth touch it, which
/// face_channels.h bakes into the rig.
struct BakeWeights : SkinWeights {
  std::optional<Side> eye;  ///< whose lids are near
  float lid_upper = 0, lid_lower = 0;
  std::int16_t lip_column = -1;  ///< index of the pair of seam vertices that corrects it
  bool by_teeth = false;         ///< may touch the teeth: held off them
  float lip_weight = 0;          ///< > 0 upper lip, < 0 lower lip
};

/// A mesh under construction: vertices with their paint and their rig, triangles by material.
struct HeadMesh {
  std::vector<glm::vec3> position;
  std::vector<glm::vec3> albedo;
  std::vector<float> openness;
  std::vector<float> opacity;
  std::vector<Bone> bone;
  std::vector<BakeWeights> weights;  ///< meaningful where bone is kSkin
  std::vector<Strand> strands;       ///< meaningful where there is hair

  struct Batch {
    Material material;
    std::vector<std::uint32_t> indices;
    int pbr = -1;  ///< see HeadTopology::Part, two_sided too
    bool two_sided = false;
  };
  std::vector<Batch> batches;
  /// The triangles of that material which take light so.
  Batch& BatchOf(Material material, int pbr = -1, bool two_sided = false);

  std::uint32_t Add(glm::vec3 p, glm::vec3 colour, float open, Bone b,
                    const BakeWeights& vertex_weights = {});
  /// A quad with corners counter-clockwise from outside; degenerate halves are left out.
  void Quad(Material material, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
  void Triangle(Material material, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                bool flip = false);
  /// Quads over a grid of `rows` x `columns` vertices that begin at `first`, row after row.
  void Grid(Material material, std::uint32_t first, int rows, int columns, bool flip = false);
};

/// Makes the triangles and parts of a topology that has none.
void SetParts(std::span<const HeadMesh::Batch> batches, HeadTopology& topology);

/// Fills the weights that follow from a place on the face alone. `side`: +1 above the mouth's slit,
/// -1 below it, 0 where the cheek joins both.
BakeWeights SkinWeightsAt(glm::vec2 domain, int side, float mouth_line_y);

}  // namespace fsm
