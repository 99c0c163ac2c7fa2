#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "fsm/mesh/gltf/gltf_document.h"
#include "fsm/mesh/gltf/gltf_nodes.h"
#include "fsm/rig/spring.h"

namespace fsm {

/// What of an avatar swings: "secondaryAnimation" of VRM 0.x and VRMC_springBone 1.0 in one form,
/// one spring for each joint, which stands where the joint ends. At most kMostSprings are read.
///
/// The formats move the end of a joint sixty times a second, or as often as is drawn, by what it
/// moved before times (1 - drag), by stiffness towards its rest and by gravity downward, and bring
/// it back to its length. For small angles that is an oscillator with w^2 = 60 (stiffness +
/// gravity) / length and 2 d w = -60 ln(1 - drag) (from VRMC_springBone 1.0, "Inertia
/// calculation"). The length counts from where the chain begins: what lies between swings along.
class VrmSprings {
 public:
  static constexpr std::size_t kMostSprings = 1000;
  VrmSprings() = default;
  VrmSprings(const GltfDocument& document, const GltfNodes& nodes);

  /// In the file's frame, lengths in metres; `outward` is 0 for those that go through everything,
  /// and down for the others: where they lie is known once the head stands.
  const std::vector<Spring>& springs() const { return springs_; }
  /// Whether a node is a joint of one of them.
  bool Has(std::int64_t node) const { return joints_.contains(node); }
  /// Adds how a vertex at `p` that a node holds by `weight` goes along with its springs: the nearer
  /// to its end, the more, else with the joint before.
  void Bind(std::uint32_t vertex, glm::vec3 p, std::int64_t node, float weight,
            std::vector<SpringWeight>& weights) const;

 private:
  /// What the formats say of a chain or of a joint.
  struct Manner {
    double stiffness = 1, gravity = 0, drag = 0.5;
    bool collides = false;
  };
  struct Joint {
    glm::vec3 from{0};        // it turns about this place
    int spring = -1;          // at its end; the last joint of a chain shares its predecessor's
    int before = -1;          // the spring that carries it; -1: the head does
    glm::vec3 chain_from{0};  // where its chain begins
  };
  void ReadOld(const nlohmann::json& animation);
  void ReadNew(const nlohmann::json& extension);
  void AddBranch(std::int64_t node, const Joint* above, const Manner& manner, int depth);
  Joint AddJoint(std::int64_t node, const Joint* above, glm::vec3 tail, const Manner& manner);
  glm::vec3 PlaceOf(std::int64_t node) const { return glm::vec3(nodes_->World(node)[3]); }

  const GltfDocument* document_ = nullptr;  // while it is read
  const GltfNodes* nodes_ = nullptr;
  std::vector<Spring> springs_;
  std::map<std::int64_t, Joint> joints_;
};

}  // namespace fsm
