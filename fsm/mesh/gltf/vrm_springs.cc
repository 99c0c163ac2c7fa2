#include "fsm/mesh/gltf/vrm_springs.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>

namespace fsm {
namespace {

using nlohmann::json;

constexpr double kStepsPerSecond = 60;
constexpr float kShortest = 0.01f;   // metres
constexpr float kEndLength = 0.07f;  // metres; length of a chain's last joint in VRM 0.x
constexpr int kMaxJoints = 100;      // of a chain

Spring SpringOf(glm::vec3 from, glm::vec3 tail, double stiffness, double gravity, double drag,
                bool collides) {
  constexpr double kSoftest = 0.02, kMaxDrag = 0.99, kReach = 0.8;
  stiffness = std::clamp(stiffness, 0.0, 100.0);
  gravity = std::clamp(gravity, 0.0, 100.0);
  const double length = std::max(glm::distance(from, tail), kShortest);
  const double force = std::max(stiffness + gravity, kSoftest);
  const double w = std::sqrt(kStepsPerSecond * force / length);
  const double decay = -kStepsPerSecond * std::log(1 - std::clamp(drag, 0.0, kMaxDrag)) / 2;
  const auto within = [](double value, float low, float high) {
    return std::clamp(static_cast<float>(value), low, high);
  };
  return {.rest = tail,
          .root = from,
          .outward = collides ? glm::vec3(0, -1, 0) : glm::vec3(0),
          .frequency_hz = within(w / (2 * std::numbers::pi), Spring::kMinHz, Spring::kMaxHz),
          .damping = within(decay / w, Spring::kMinDamping, Spring::kMaxDamping),
          .hang = static_cast<float>(gravity / force),
          .reach_mm = static_cast<float>(kReach * length)};
}

}  // namespace

VrmSprings::VrmSprings(const GltfDocument& document, const GltfNodes& nodes)
    : document_(&document), nodes_(&nodes) {
  const json& extensions = JsonMember(document.root(), "extensions");
  if (extensions.contains("VRMC_springBone")) {
    ReadVrm1(JsonMember(extensions, "VRMC_springBone"));
  } else {
    ReadVrm0(JsonMember(JsonMember(extensions, "VRM"), "secondaryAnimation"));
  }
  document_ = nullptr;
  nodes_ = nullptr;
}

VrmSprings::Joint VrmSprings::AddJoint(std::int64_t node, const Joint* above, glm::vec3 tail,
                                       const Dynamics& dynamics) {
  Joint joint{.position = PositionOf(node)};
  joint.chain_start = above != nullptr ? above->chain_start : joint.position;
  joint.before = above != nullptr ? above->spring : -1;
  joint.spring = static_cast<int>(springs_.size());
  springs_.push_back(SpringOf(joint.chain_start, tail, dynamics.stiffness, dynamics.gravity,
                              dynamics.drag, dynamics.collides));
  joints_.emplace(node, joint);
  return joint;
}

void VrmSprings::ReadVrm1(const json& extension) {
  for (const json& chain : JsonMember(extension, "springs")) {
    const bool collides = !JsonMember(chain, "colliderGroups").empty();
    const json& joints = JsonMember(chain, "joints");
    if (!joints.is_array()) continue;
    Joint above;
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const std::int64_t node = JsonInteger(joints[k], "node");
      if (!nodes_->Has(node) || joints_.contains(node) || springs_.size() >= kMaxSprings) break;
      if (k + 1 == joints.size()) {  // the last one only marks the end of the one before
        if (k > 0) joints_.emplace(node, Joint{.spring = above.spring, .ends_chain = true});
        break;
      }
      const std::int64_t next = JsonInteger(joints[k + 1], "node");
      if (!nodes_->Has(next)) break;
      above = AddJoint(node, k > 0 ? &above : nullptr, PositionOf(next),
                       {.stiffness = JsonNumber(joints[k], "stiffness", 1),
                        .gravity = JsonNumber(joints[k], "gravityPower", 0),
                        .drag = JsonNumber(joints[k], "dragForce", 0.5),
                        .collides = collides});
    }
  }
}

void VrmSprings::ReadVrm0(const json& animation) {
  for (const json& group : JsonMember(animation, "boneGroups")) {
    const Dynamics dynamics{
        .stiffness = JsonNumber(group, "stiffiness", 1),  // spelling of the format
        .gravity = JsonNumber(group, "gravityPower", 0),
        .drag = JsonNumber(group, "dragForce", 0.4),
        .collides = !JsonMember(group, "colliderGroups").empty()};
    for (const std::int64_t bone : JsonIntegers(group, "bones"))
      AddBranch(bone, nullptr, dynamics, 0);
  }
}

void VrmSprings::AddBranch(std::int64_t node, const Joint* above, const Dynamics& dynamics,
                           int depth) {
  if (!nodes_->Has(node) || joints_.contains(node)) return;
  if (depth > kMaxJoints || springs_.size() >= kMaxSprings) return;
  const auto children = JsonIntegers(document_->At("nodes", node), "children");
  const glm::vec3 from = PositionOf(node);
  glm::vec3 tail = from;
  if (!children.empty()) {
    tail = PositionOf(children.front());
  } else if (above != nullptr && glm::distance(from, above->position) > 1e-6f) {
    tail += kEndLength * glm::normalize(from - above->position);
  } else {
    tail.y -= kEndLength;
  }
  const Joint joint = AddJoint(node, above, tail, dynamics);
  for (const std::int64_t child : children) AddBranch(child, &joint, dynamics, depth + 1);
}

void VrmSprings::Bind(std::uint32_t vertex, glm::vec3 p, std::int64_t node, float weight,
                      std::vector<SpringWeight>& weights) const {
  const auto found = joints_.find(node);
  if (found == joints_.end()) return;
  const Joint& joint = found->second;
  const auto add = [&](int spring, float share) {
    if (spring >= 0 && share > 1e-3f)
      weights.push_back({vertex, static_cast<std::uint32_t>(spring), share});
  };
  if (joint.ends_chain) {
    add(joint.spring, weight);
    return;
  }
  const glm::vec3 along = springs_[static_cast<std::size_t>(joint.spring)].rest - joint.position;
  const float length = std::max(glm::dot(along, along), kShortest * kShortest);
  const float share = std::clamp(glm::dot(p - joint.position, along) / length, 0.0f, 1.0f);
  add(joint.spring, weight * share);
  add(joint.before, weight * (1 - share));
}

}  // namespace fsm
