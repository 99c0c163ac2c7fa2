#include "fsm/mesh/original/lip_seal.h"

#include <array>

#include "fsm/base/smooth_step.h"
#include "fsm/mesh/transfer/mesh_paths.h"

namespace fsm {

LipRig LipsOf(const UnriggedHead& model, std::size_t count) {
  LipRig rig;
  const auto& seam = model.mouth.seam;
  if (seam.empty()) return rig;
  for (const auto& [upper, lower] : seam) {
    rig.apart_at_rest.push_back(model.mesh.position[upper] - model.mesh.position[lower]);
  }
  // Measure along the surface, because across the slit the other lip is as near.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& batch : model.mesh.batches) {
    if (batch.material != Material::kSkin && batch.material != Material::kLip) continue;
    for (std::size_t i = 0; i + 2 < batch.indices.size(); i += 3) {
      triangles.push_back({batch.indices[i], batch.indices[i + 1], batch.indices[i + 2]});
    }
  }
  const Neighbours next = NeighboursAlongEdges(model.mesh.position.size(), triangles);
  std::vector<std::uint32_t> pairs;
  for (std::uint32_t k = 0; k < seam.size(); ++k) {
    if (seam[k].first != seam[k].second) pairs.push_back(k);  // equal at the corners
  }
  constexpr float kReach = 11;  // mm; greatest distance from the seam
  for (const bool upper : {true, false}) {
    std::vector<std::uint32_t> edge;
    for (const std::uint32_t k : pairs) {
      edge.push_back(upper ? seam[k].first : seam[k].second);
    }
    const MeshPaths paths = ShortestPaths(next, model.mesh.position, edge, kReach);
    for (std::uint32_t v = 0; v < count; ++v) {
      const float share = SmoothStep(kReach, 0, paths.length[v]);
      if (share > 0) rig.followers.push_back({v, pairs[paths.seed[v]], upper ? share : -share});
    }
  }
  return rig;
}

}  // namespace fsm
