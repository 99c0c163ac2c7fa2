#include "fsm/mesh/gltf/gltf_targets.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "fsm/mesh/mesh_limits.h"
#include "fsm/rig/reach.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxShapes = 400;
constexpr std::size_t kMaxDeltas = 20'000'000;

}  // namespace

void Refuse(const GltfDocument& document, const std::string& what) {
  throw vm::Failure(document.Fail(what).error());
}

std::string VertexName(const GltfMeshInstance& instance, std::size_t vertex) {
  return "meshes[" + std::to_string(instance.mesh) + "] of nodes[" + std::to_string(instance.node) +
         "]: vertex " + std::to_string(vertex);
}

void RefuseReach(const GltfDocument& document, const std::string& what) {
  Refuse(document, what + " comes to lie farther than " +
                       std::to_string(static_cast<long>(kMaxReach)) + " metres from the origin");
}

void RefuseSize(const GltfDocument& document) {
  throw vm::Failure({vm::Errc::kLimit, document.name() + ": at most " +
                                           std::to_string(kMaxMeshVertices) + " vertices, " +
                                           std::to_string(kMaxMeshTriangles) + " triangles and " +
                                           std::to_string(kMaxShapes) + " shapes are read"});
}

void GltfTargets::Read(const json& primitive, const GltfMeshInstance& instance,
                       std::span<const glm::mat4> transforms, std::size_t first,
                       const std::vector<std::string>& names) {
  const json& targets = JsonMember(primitive, "targets");
  for (std::size_t t = 0; t < targets.size(); ++t) {
    if (!targets.is_array() || !targets[t].contains("POSITION")) continue;
    const auto by = vm::OrThrow(document_.Numbers(JsonInteger(targets[t], "POSITION"), 3));
    if (by.size() < 3 * transforms.size()) {
      Refuse(document_, "meshes[" + std::to_string(instance.mesh) + "]: target " +
                            std::to_string(t) + " has fewer vertices than the mesh");
    }
    const std::string name = t < names.size() ? names[t] : "target" + std::to_string(t);
    const auto [known, fresh] = shape_of_.try_emplace(name, head_.shapes.size());
    if (fresh) {
      if (head_.shapes.size() >= kMaxShapes) RefuseSize(document_);
      head_.shapes.push_back({name, {}});
    }
    moved_[{instance.mesh, t}].push_back({.shape = known->second,
                                          .node = instance.node,
                                          .first = first,
                                          .end = first + transforms.size()});
    auto& deltas = head_.shapes[known->second].deltas;
    for (std::size_t i = 0; i < transforms.size(); ++i) {
      const glm::vec3 d(by[3 * i], by[3 * i + 1], by[3 * i + 2]);
      if (d == glm::vec3(0)) continue;
      const glm::vec3 moved(transforms[i] * glm::vec4(d, 0));
      if (!WithinReach(moved)) {
        RefuseReach(document_,
                    VertexName(instance, i) + " is moved by target " + std::to_string(t) + " and");
      }
      deltas.push_back({static_cast<std::uint32_t>(first + i), moved});
      if (++deltas_ > kMaxDeltas) RefuseSize(document_);
    }
  }
}

void GltfTargets::AddExpression(const VrmAvatar::Expression& expression) {
  ImportedHead::Shape shape{"vrm" + expression.name, {}};
  for (const VrmAvatar::Bind& bind : expression.binds) AddBind(shape, bind);
  if (!shape.deltas.empty() && head_.shapes.size() < kMaxShapes)
    head_.shapes.push_back(std::move(shape));
}

void GltfTargets::AddBind(ImportedHead::Shape& shape, const VrmAvatar::Bind& bind) {
  if (bind.target < 0) return;
  const auto found = moved_.find({bind.mesh, static_cast<std::size_t>(bind.target)});
  if (found == moved_.end()) return;
  for (const Moved& moved : found->second) {
    if (bind.node >= 0 && moved.node != bind.node) continue;
    for (const auto& delta : head_.shapes[moved.shape].deltas) {
      // Targets of the same name in several meshes form one shape; the bind is to this mesh only.
      if (delta.vertex < moved.first || delta.vertex >= moved.end) continue;
      if (++deltas_ > kMaxDeltas) return;
      // Weights in VRM are from 0 to 1; values far beyond indicate a damaged file.
      const auto weight = static_cast<float>(std::clamp(bind.weight, -10.0, 10.0));
      shape.deltas.push_back({delta.vertex, weight * delta.by});
    }
  }
}

}  // namespace fsm
