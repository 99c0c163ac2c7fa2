#include "fsm/mesh/gltf/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>
#include <string>

namespace fsm {
namespace {

using nlohmann::json;

constexpr int kMaxNodeDepth = 200;
const glm::mat4 kIdentity(1.0f);

glm::mat4 MatrixOf(const json& node) {
  glm::mat4 m(1.0f);
  const auto read = [&node](const char* key, float* first, std::size_t count) {
    if (JsonMember(node, key).size() == count) JsonNumbers(node, key, std::span(first, count));
  };
  if (JsonMember(node, "matrix").size() == 16) {
    read("matrix", &m[0][0], 16);
    return m;
  }
  glm::vec3 move(0), size(1);
  glm::vec4 q(0, 0, 0, 1);
  read("translation", &move.x, 3);
  read("scale", &size.x, 3);
  read("rotation", &q.x, 4);
  m = glm::mat4_cast(glm::quat(q.w, q.x, q.y, q.z));
  for (int c = 0; c < 3; ++c) m[c] *= size[c];
  m[3] = glm::vec4(move, 1);
  return m;
}

/// Tells whether all numbers of a transformation are finite.
bool Usable(const glm::mat4& m) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(m[c][r])) return false;
    }
  }
  return true;
}

}  // namespace

GltfNodes::GltfNodes(const GltfDocument& document) {
  const std::size_t count = document.Count("nodes");
  world_.assign(count, kIdentity);
  computed_.assign(count, false);
  std::vector<bool> child(count, false);
  for (std::size_t i = 0; i < count; ++i) {
    const json& node = document.At("nodes", static_cast<std::int64_t>(i));
    for (const std::int64_t index : JsonIntegers(node, "children")) {
      if (index >= 0 && static_cast<std::size_t>(index) < count) {
        child[static_cast<std::size_t>(index)] = true;
      }
    }
  }
  std::vector<std::int64_t> roots;
  for (std::size_t i = 0; i < count; ++i) {
    if (child[i]) continue;
    roots.push_back(static_cast<std::int64_t>(i));
    ComputeWorld(document, roots.back(), kIdentity, 0);
  }
  const json& scene = document.At("scenes", JsonInteger(document.root(), "scene", 0));
  std::vector<bool> seen(count, false);
  for (const std::int64_t node : JsonIntegers(scene, "nodes")) Show(document, node, seen);
  if (shown_.empty()) {
    for (const std::int64_t root : roots) Show(document, root, seen);
  }
}

void GltfNodes::ComputeWorld(const GltfDocument& document, std::int64_t node,
                             const glm::mat4& above, int depth) {
  if (node < 0 || static_cast<std::size_t>(node) >= world_.size()) return;
  const auto at = static_cast<std::size_t>(node);
  if (depth > kMaxNodeDepth || computed_[at]) {
    RefuseFile("nodes[" + std::to_string(node) + "]: nodes that are their own parents");
  }
  computed_[at] = true;
  world_[at] = above * MatrixOf(document.At("nodes", node));
  if (!Usable(world_[at])) {
    RefuseFile("nodes[" + std::to_string(node) + "]: its place is no finite number");
  }
  for (const std::int64_t child : JsonIntegers(document.At("nodes", node), "children")) {
    ComputeWorld(document, child, world_[at], depth + 1);
  }
}

void GltfNodes::Show(const GltfDocument& document, std::int64_t node, std::vector<bool>& seen) {
  // Nodes in a cycle are under no root, so ComputeWorld did not reach them.
  if (node < 0 || static_cast<std::size_t>(node) >= seen.size()) return;
  const auto at = static_cast<std::size_t>(node);
  if (seen[at] || !computed_[at]) return;
  seen[at] = true;
  shown_.push_back(node);
  for (const std::int64_t child : JsonIntegers(document.At("nodes", node), "children")) {
    Show(document, child, seen);
  }
}

const glm::mat4& GltfNodes::World(std::int64_t node) const {
  if (!Has(node)) return kIdentity;
  return world_[static_cast<std::size_t>(node)];
}

GltfSkin::GltfSkin(const GltfDocument& document, const GltfNodes& nodes, std::int64_t skin) {
  const json& given = document.At("skins", skin);
  std::vector<float> inverse;
  if (given.contains("inverseBindMatrices")) {
    inverse = document.Numbers(JsonInteger(given, "inverseBindMatrices"), 16);
  }
  for (const json& joint : JsonMember(given, "joints")) {
    const std::int64_t node = joint.is_number_integer() ? joint.get<std::int64_t>() : -1;
    glm::mat4 from(1.0f);
    for (std::size_t k = 0; k < 16 && 16 * node_.size() + k < inverse.size(); ++k) {
      from[static_cast<int>(k / 4)][static_cast<int>(k % 4)] = inverse[16 * node_.size() + k];
    }
    const glm::mat4 takes = nodes.World(node) * from;
    joint_transform_.push_back(Usable(takes) ? takes : kIdentity);
    node_.push_back(node);
  }
}

GltfSkin::Skinned GltfSkin::Apply(const GltfDocument& document, const json& attributes,
                                  std::size_t count, const glm::mat4& transform,
                                  const std::function<bool(std::int64_t)>& watched) const {
  Skinned skinned;
  skinned.transform.assign(count, glm::mat4(0.0f));
  skinned.main.assign(count, -1);
  std::vector<float> total(count, 0), most(count, 0);
  for (const char* set : {"0", "1"}) {
    const std::string joints = std::string("JOINTS_") + set,
                      weights = std::string("WEIGHTS_") + set;
    if (!attributes.contains(joints) || !attributes.contains(weights)) continue;
    const auto which = document.Numbers(JsonInteger(attributes, joints.c_str()), 4);
    const auto shares = document.Numbers(JsonInteger(attributes, weights.c_str()), 4);
    for (std::size_t i = 0; i < std::min({4 * count, which.size(), shares.size()}); ++i) {
      const float weight = shares[i], number = which[i];
      if (!(weight > 0) || !(number >= 0) || number >= static_cast<float>(joint_transform_.size()))
        continue;
      const auto joint = static_cast<std::size_t>(number);
      skinned.transform[i / 4] += weight * joint_transform_[joint];
      total[i / 4] += weight;
      if (watched(node_[joint])) skinned.watched.push_back({i / 4, node_[joint], weight});
      if (weight > most[i / 4]) {
        most[i / 4] = weight;
        skinned.main[i / 4] = node_[joint];
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    skinned.transform[i] = total[i] > 1e-4f ? (1 / total[i]) * skinned.transform[i] : transform;
  }
  std::erase_if(skinned.watched, [&](const Skinned::Influence& influence) {
    return total[influence.vertex] <= 1e-4f;
  });
  for (Skinned::Influence& influence : skinned.watched) influence.weight /= total[influence.vertex];
  return skinned;
}

}  // namespace fsm
