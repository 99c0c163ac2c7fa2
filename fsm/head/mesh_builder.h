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

/// The weights of a vertex while its head is made: those of the rig, and its parts in lids, lips
/// and teeth, which face_channels.h bakes into the rig. Rigid parts have them as they are by
/// default, but for `follows`.
struct BakeWeights {
  SkinWeights skin{};
  /// What it moves with as the base head takes its form (HeadForm). Eyes, jaw and tongue have their
  /// bones.
  enum class Follows { kFace, kTeeth, kNothing } follows = Follows::kFace;
  std::optional<Side> eye{};  ///< the side of the lids near it
  float lid_upper = 0, lid_lower = 0;
  std::int16_t lip_column = -1;  ///< index of the seam pair that corrects it
  bool by_teeth = false;         ///< may touch the teeth, and is then pushed off them
  float lip_weight = 0;          ///< > 0 upper lip, < 0 lower lip
};

/// A mesh under construction: vertices with paint and rig, triangles by material.
struct MeshBuilder {
  std::vector<glm::vec3> position;
  std::vector<glm::vec3> albedo;
  std::vector<float> openness;
  std::vector<float> opacity;
  std::vector<Bone> bone;
  std::vector<BakeWeights> weights;
  std::vector<Strand> strands;  ///< meaningful on hair only

  struct Batch {
    Material material;
    std::vector<std::uint32_t> indices;
    int pbr = -1;  ///< as in HeadSurface::Part; also two_sided
    bool two_sided = false;
  };
  std::vector<Batch> batches;
  /// Returns the batch of triangles with this material and shading.
  Batch& BatchOf(Material material, int pbr = -1, bool two_sided = false);

  std::uint32_t Add(glm::vec3 p, glm::vec3 colour, float open, Bone b,
                    const BakeWeights& vertex_weights = {});
  /// Adds a quad with corners counter-clockwise from outside, without degenerate halves.
  void Quad(Material material, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
  void Triangle(Material material, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                bool flip = false);
  /// Adds quads over a grid of `rows` x `columns` vertices, row by row from `first`.
  void Grid(Material material, std::uint32_t first, int rows, int columns, bool flip = false);
};

/// Fills the triangles and parts of a surface that has none.
void SetParts(std::span<const MeshBuilder::Batch> batches, HeadSurface& surface);

/// Returns how far the neck turns with the head at a height: fully at the jaw, not at the
/// shoulders.
float NeckWeight(float y);

}  // namespace fsm
