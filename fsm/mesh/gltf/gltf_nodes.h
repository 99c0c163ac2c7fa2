#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "fsm/mesh/gltf/gltf_document.h"

namespace fsm {

/// The transformations of the nodes of a glTF file at rest.
class GltfNodes {
 public:
  /// Throws as GltfDocument, of nodes that are their own parents.
  explicit GltfNodes(const GltfDocument& document);
  bool Has(std::int64_t node) const {
    return node >= 0 && static_cast<std::size_t>(node) < world_.size();
  }
  /// Returns a node's transformation to the scene; the identity if there is no such node.
  const glm::mat4& World(std::int64_t node) const;
  /// The nodes of the file's scene, parents before children; all nodes if it has no scene.
  std::span<const std::int64_t> shown() const { return shown_; }

 private:
  void ComputeWorld(const GltfDocument& document, std::int64_t node, const glm::mat4& above,
                    int depth);
  void Show(const GltfDocument& document, std::int64_t node, std::vector<bool>& seen);
  std::vector<glm::mat4> world_;
  std::vector<bool> computed_;
  std::vector<std::int64_t> shown_;
};

/// A skin at rest: the matrices that take vertices from the mesh's bind pose to the rest pose of
/// the nodes. The two differ in files of exporters that scale or rotate the skeleton.
class GltfSkin {
 public:
  /// Throws as GltfDocument, of the inverse bind matrices.
  GltfSkin(const GltfDocument& document, const GltfNodes& nodes, std::int64_t skin);
  /// The result of Apply. `transform`: the matrix of each vertex, the argument `transform` for
  /// those without weights. `main`: the node of the joint with the greatest weight, -1 for none.
  struct Skinned {
    struct Influence {
      std::size_t vertex;
      std::int64_t node;
      float weight;
    };
    std::vector<glm::mat4> transform;
    std::vector<std::int64_t> main;
    /// All influences of the nodes for which the argument `watched` is true.
    std::vector<Influence> watched;
  };
  Skinned Apply(const GltfDocument& document, const nlohmann::json& attributes, std::size_t count,
                const glm::mat4& transform,
                const std::function<bool(std::int64_t node)>& watched) const;

 private:
  std::vector<glm::mat4> joint_transform_;
  std::vector<std::int64_t> node_;
};

}  // namespace fsm
