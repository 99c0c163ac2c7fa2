#include "fsm/mesh/gltf/gltf_targets.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "fsm/mesh/mesh_limits.h"
#include "fsm/rig/reach.h"

namespace fsm {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxShapes = 400;
constexpr std::size_t kMaxDeltas = 20'000'000;

}  // namespace

std::string VertexName(const GltfMeshInstance& instance, std::size_t vertex) {
  return "meshes[" + std::to_string(instance.mesh) + "] of nodes[" + std::to_string(instance.node) +
         "]: vertex " + std::to_string(vertex);
}

void RefuseReach(const std::string& what) {
  RefuseFile(what + " comes to lie farther than " + std::to_string(static_cast<long>(kMaxReach)) +
             " metres from the origin");
}

void RefuseSize() {
  throw vm::Failure({vm::Errc::kLimit, "at most " + std::to_string(kMaxMeshVertices) +
                                           " vertices, " + std::to_string(kMaxMeshTriangles) +
                                           " triangles and " + std::to_string(kMaxShapes) +
                                           " shapes are read"});
}

void GltfTargets::Read(const json& primitive, const GltfMeshInstance& instance,
                       std::span<const glm::mat4> transforms, std::size_t first,
                       const std::vector<std::string>& names) {
  const json& targets = JsonMember(primitive, "targets");
  for (std::size_t t = 0; t < targets.size(); ++t) {
    if (!targets.is_array() || !targets[t].contains("POSITION")) continue;
    const auto by = document_.Numbers(JsonInteger(targets[t], "POSITION"), 3);
    if (by.size() < 3 * transforms.size()) {
      RefuseFile("meshes[" + std::to_string(instance.mesh) + "]: target " + std::to_string(t) +
                 " has fewer vertices than the mesh");
    }
    const std::string name = t < names.size() ? names[t] : "target" + std::to_string(t);
    const auto [known, fresh] = shape_of_.try_emplace(name, head_.shapes.size());
    if (fresh) {
      if (head_.shapes.size() >= kMaxShapes) RefuseSize();
      head_.shapes.push_back({name, {}});
    }
    moved_[{instance.mesh, t}].push_back({.shape = known->second,
                                          .node = instance.node,
                                          .first = first,
                                          .end = first + transforms.size()});
    auto& moves = head_.shapes[known->second].moves;
    for (std::size_t i = 0; i < transforms.size(); ++i) {
      const glm::vec3 d(by[3 * i], by[3 * i + 1], by[3 * i + 2]);
      if (d == glm::vec3(0)) continue;
      const glm::vec3 moved(transforms[i] * glm::vec4(d, 0));
      if (!WithinReach(moved)) {
        RefuseReach(VertexName(instance, i) + " is moved by target " + std::to_string(t) + " and");
      }
      moves.push_back({static_cast<std::uint32_t>(first + i), moved});
      if (++deltas_ > kMaxDeltas) RefuseSize();
    }
  }
}

void GltfTargets::AddExpression(const VrmAvatar::Expression& expression) {
  ImportedHead::Shape shape{"vrm" + expression.name, {}};
  for (const VrmAvatar::Bind& bind : expression.binds) AddBind(shape, bind);
  if (!shape.moves.empty() && head_.shapes.size() < kMaxShapes)
    head_.shapes.push_back(std::move(shape));
}

void GltfTargets::AddBind(ImportedHead::Shape& shape, const VrmAvatar::Bind& bind) {
  if (bind.target < 0) return;
  const auto found = moved_.find({bind.mesh, static_cast<std::size_t>(bind.target)});
  if (found == moved_.end()) return;
  for (const Moved& moved : found->second) {
    if (bind.node >= 0 && moved.node != bind.node) continue;
    for (const auto& [vertex, by] : head_.shapes[moved.shape].moves) {
      // Targets of the same name in several meshes form one shape; the bind is to this mesh only.
      if (vertex < moved.first || vertex >= moved.end) continue;
      if (++deltas_ > kMaxDeltas) return;
      // Weights in VRM are from 0 to 1; values far beyond indicate a damaged file.
      const auto weight = static_cast<float>(std::clamp(bind.weight, -10.0, 10.0));
      shape.moves.push_back({vertex, weight * by});
    }
  }
}

}  // namespace fsm
