#include "fsm/mesh/lip_seal.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <queue>

#include "fsm/base/spline.h"

namespace fsm {

LipSeal::LipSeal(const MeshModel& model, std::size_t count) : seam_(model.seam) {
  if (seam_.empty()) return;
  for (const auto& [upper, lower] : seam_) {
    apart_at_rest_.push_back(model.position[upper] - model.position[lower]);
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
    for (std::uint32_t k = 0; k < seam_.size(); ++k) {
      if (seam_[k].first == seam_[k].second) continue;  // a corner
      open.push({0, upper ? seam_[k].first : seam_[k].second, k});
    }
    while (!open.empty()) {
      const Way way = open.top();
      open.pop();
      if (way.far >= far[way.vertex] || way.far > kReach) continue;
      far[way.vertex] = way.far;
      const float part = SmoothStep(kReach, 0, way.far);
      if (way.vertex < count && part > 0) {
        followers_.push_back({way.vertex, way.pair, upper ? part : -part});
      }
      for (const std::uint32_t v : next[way.vertex]) {
        open.push(
            {way.far + glm::distance(model.position[way.vertex], model.position[v]), v, way.pair});
      }
    }
  }
}

void LipSeal::Close(float seal, std::span<glm::vec3> position) const {
  // Upper and lower lip share the way to each other as in Deformer.
  constexpr float kUpperShare = 0.4f;
  std::vector<glm::vec3> correction;
  correction.reserve(seam_.size());
  for (std::size_t k = 0; k < seam_.size(); ++k) {
    const glm::vec3 apart =
        position[seam_[k].first] - position[seam_[k].second] - apart_at_rest_[k];
    glm::vec3 by = seal * apart;
    by.y += (1 - seal) * std::min(apart.y, 0.0f);
    correction.push_back(by);
  }
  for (const Follower& f : followers_) {
    position[f.vertex] -=
        (f.part > 0 ? kUpperShare : 1 - kUpperShare) * f.part * correction[f.pair];
  }
}

}  // namespace fsm
