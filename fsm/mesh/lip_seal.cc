#include "fsm/mesh/lip_seal.h"

#include <glm/geometric.hpp>
#include <queue>

#include "fsm/base/spline.h"

namespace fsm {

LipRig LipsOf(const MeshModel& model, std::size_t count) {
  LipRig rig;
  rig.seam = model.seam;
  if (rig.seam.empty()) return rig;
  for (const auto& [upper, lower] : rig.seam) {
    rig.apart_at_rest.push_back(model.position[upper] - model.position[lower]);
  }
  // Along the surface, because across the slit the other lip is as near.
  std::vector<std::vector<std::uint32_t>> next(model.position.size());
  for (const auto& batch : model.batches) {
    if (batch.material != Material::kSkin && batch.material != Material::kLip) continue;
    for (std::size_t i = 0; i + 2 < batch.indices.size(); i += 3) {
      for (std::size_t k = 0; k < 3; ++k) {
        next[batch.indices[i + k]].push_back(batch.indices[i + (k + 1) % 3]);
        next[batch.indices[i + (k + 1) % 3]].push_back(batch.indices[i + k]);
      }
    }
  }
  constexpr float kReach = 11;  // millimetres from the seam
  for (const bool upper : {true, false}) {
    struct Way {
      float far;
      std::uint32_t vertex, pair;
      bool operator<(const Way& other) const { return far > other.far; }
    };
    std::priority_queue<Way> open;
    std::vector<float> far(model.position.size(), 1e9f);
    for (std::uint32_t k = 0; k < rig.seam.size(); ++k) {
      if (rig.seam[k].first == rig.seam[k].second) continue;  // a corner
      open.push({0, upper ? rig.seam[k].first : rig.seam[k].second, k});
    }
    while (!open.empty()) {
      const Way way = open.top();
      open.pop();
      if (way.far >= far[way.vertex] || way.far > kReach) continue;
      far[way.vertex] = way.far;
      const float part = SmoothStep(kReach, 0, way.far);
      if (way.vertex < count && part > 0) {
        rig.followers.push_back({way.vertex, way.pair, upper ? part : -part});
      }
      for (const std::uint32_t v : next[way.vertex]) {
        open.push(
            {way.far + glm::distance(model.position[way.vertex], model.position[v]), v, way.pair});
      }
    }
  }
  return rig;
}

}  // namespace fsm
