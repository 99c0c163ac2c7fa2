#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

namespace fsm {

class WeldedSurface;

/// What lies so near to its opposite that the nearest point may be on the wrong one.
enum class FaceFeature : std::uint8_t { kNone, kUpperLip, kLowerLip, kUpperLid, kLowerLid };

/// Corresponding points of two faces, millimetres.
struct PointPair {
  glm::vec3 from, to;
  FaceFeature feature = FaceFeature::kNone;
};

/// The source or the target of a transfer. Both are in the same frame, roughly aligned.
struct TransferSurface {
  std::span<const glm::vec3> position;       ///< all vertices, at rest
  std::span<const std::uint32_t> triangles;  ///< of flesh, outside counter-clockwise
  /// Whether vertices are duplicated along texture seams. If not, two vertices at one position are
  /// distinct, as where closed lips meet.
  bool has_uv_seams = false;
  std::span<const std::uint32_t> eyes = {};  ///< triangles of the eyeballs, which hide the sockets
};

/// Transfers displacements from one face to another with any mesh (expression cloning, Noh and
/// Neumann 2001): landmarks define a radial warp, the warped source is projected onto the target,
/// and each target vertex follows the source point nearest to it. Unlike in that paper,
/// displacements keep their size and direction: with local rotation and scaling, the large motions
/// of the jaw tore the skin, and shapes transferred to another head and back came out a third
/// smaller. Upper and lower lips and lids are distinguished by distances along the surface, so that
/// neither is matched with the other; measured on meshes whose edges are up to 8 mm long.
/// Immutable; thread: any.
class DeformationTransfer {
 public:
  /// Throws std::runtime_error if there are fewer than eight pairs or they are (nearly) coplanar,
  /// if a point or a vertex exceeds kMaxReach, and as WeldedSurface and SurfaceIndex.
  DeformationTransfer(const TransferSurface& from, const TransferSurface& to,
                      std::span<const PointPair> pairs);
  /// For a target vertex, the source vertices that it follows and their weights, which add up to 1;
  /// empty if it follows none.
  using Row = std::vector<std::pair<std::uint32_t, float>>;
  std::span<const Row> rows() const { return rows_; }
  /// Adds the transferred displacements of the source, `from_by`, to those of the target; both are
  /// indexed by vertex.
  void Apply(std::span<const glm::vec3> from_by, std::span<glm::vec3> to_by) const;

 private:
  struct BarycentricBinding {
    std::array<std::uint32_t, 3> corner{};
    glm::vec3 barycentric{1, 0, 0};
  };
  /// Returns the binding of each welded vertex of the target.
  static std::vector<BarycentricBinding> Bind(const WeldedSurface& rest,
                                              const WeldedSurface& pulled,
                                              const WeldedSurface& target);
  void MakeRows(std::span<const BarycentricBinding> bindings, const WeldedSurface& target);

  std::vector<Row> rows_;
};

}  // namespace fsm
