#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

namespace fsm {

class WeldedSurface;

/// What lies so near to its opposite that the nearest place may be the wrong one.
enum class FacePart : std::uint8_t { kPlain, kUpperLip, kLowerLip, kUpperLid, kLowerLid };

/// The same place on two faces, millimetres.
struct PointPair {
  glm::vec3 from, to;
  FacePart part = FacePart::kPlain;
};

/// A face to carry motion from or to. Both lie in the same frame, nearly over each other.
struct TransferSurface {
  std::span<const glm::vec3> position;       ///< all vertices, at rest
  std::span<const std::uint32_t> triangles;  ///< of flesh, outside counter-clockwise
  /// Vertices are doubled where the texture is sewn together. Else two at one place are two, as
  /// where closed lips meet.
  bool has_uv_seams = false;
  std::span<const std::uint32_t> eyes = {};  ///< triangles of the eyeballs: sockets are behind them
};

/// Carries displacements of one face over to another, whatever its mesh: landmarks guide a radial
/// warp, the warped surface is then pulled onto the other, and every vertex follows the place of
/// the first face it came to lie on (expression cloning, Noh and Neumann 2001). Motion keeps its
/// size and direction: turned and stretched with the local surface, as in that paper, the large
/// motions of a jaw tear, and shapes brought to another head and back came out a third smaller.
/// Upper and lower lips and lids are told apart along the surface, so that they are never taken for
/// each other. Immutable; thread: any.
class DeformationTransfer {
 public:
  /// Throws std::runtime_error if there are fewer than eight pairs or they lie (nearly) in a plane,
  /// if a place or a vertex lies out of kMaxMeshReach, and as WeldedSurface and SurfaceIndex.
  DeformationTransfer(const TransferSurface& from, const TransferSurface& to,
                      std::span<const PointPair> pairs);
  /// For each vertex of the second face the vertices of the first whose motions it takes, and the
  /// part of each; parts add up to 1, where nothing moves it there are none.
  using Row = std::vector<std::pair<std::uint32_t, float>>;
  std::span<const Row> rows() const { return rows_; }
  /// Adds to `to_by` what `from_by` means there; both by vertex.
  void Apply(std::span<const glm::vec3> from_by, std::span<glm::vec3> to_by) const;

 private:
  struct BarycentricBinding {
    std::array<std::uint32_t, 3> corner{};
    glm::vec3 part{1, 0, 0};
  };
  /// For each vertex of the second face, doubled ones counted once.
  static std::vector<BarycentricBinding> Bind(const WeldedSurface& rest,
                                              const WeldedSurface& pulled,
                                              const WeldedSurface& target);
  void MakeRows(std::span<const BarycentricBinding> bindings, const WeldedSurface& target);

  std::vector<Row> rows_;
};

}  // namespace fsm
