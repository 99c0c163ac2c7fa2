#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "fsm/mesh/gltf/gltf_document.h"
#include "fsm/mesh/gltf/gltf_nodes.h"
#include "fsm/rig/spring.h"

namespace fsm {

/// The swinging parts of an avatar: "secondaryAnimation" of VRM 0.x and VRMC_springBone 1.0 in one
/// form. Each joint has one spring, at the joint's end. At most kMaxSprings are read.
///
/// In these formats, sixty times a second or once per frame, the end of a joint moves by its
/// previous displacement times (1 - drag), by stiffness towards its rest and by gravity downward;
/// then the joint's length is restored. For small angles that is an oscillator with w^2 = 60
/// (stiffness + gravity) / length and 2 d w = -60 ln(1 - drag) (from VRMC_springBone 1.0, "Inertia
/// calculation"). The length is measured from the start of the chain, because the joints between
/// swing as well.
class VrmSprings {
 public:
  static constexpr std::size_t kMaxSprings = 1000;
  VrmSprings() = default;
  VrmSprings(const GltfDocument& document, const GltfNodes& nodes);

  /// In the file's frame, lengths in metres. `outward` is 0 for springs without collisions, and
  /// points down for the others; their final value is set when the head has been placed.
  const std::vector<Spring>& springs() const { return springs_; }
  /// Tells whether a node is a joint with a spring.
  bool Has(std::int64_t node) const { return joints_.contains(node); }
  /// Adds the spring weights of a vertex at `p` that a node influences by `weight`: the nearer to
  /// the joint's end, the more of its spring, the rest of the spring of the joint before.
  void Bind(std::uint32_t vertex, glm::vec3 p, std::int64_t node, float weight,
            std::vector<SpringWeight>& weights) const;

 private:
  /// The parameters of a chain or joint.
  struct Dynamics {
    double stiffness = 1, gravity = 0, drag = 0.5;
    bool collides = false;
  };
  struct Joint {
    glm::vec3 position{0};     // the centre of its rotation
    int spring = -1;           // at its end
    int before = -1;           // the spring of its parent; -1: none, it is fixed to the head
    bool ends_chain = false;   // it only marks the end of its predecessor, whose spring it has
    glm::vec3 chain_start{0};  // of its chain
  };
  void ReadVrm0(const nlohmann::json& animation);
  void ReadVrm1(const nlohmann::json& extension);
  void AddBranch(std::int64_t node, const Joint* above, const Dynamics& dynamics, int depth);
  Joint AddJoint(std::int64_t node, const Joint* above, glm::vec3 tail, const Dynamics& dynamics);
  glm::vec3 PositionOf(std::int64_t node) const { return glm::vec3(nodes_->World(node)[3]); }

  const GltfDocument* document_ = nullptr;  // while it is read
  const GltfNodes* nodes_ = nullptr;
  std::vector<Spring> springs_;
  std::map<std::int64_t, Joint> joints_;
};

}  // namespace fsm
