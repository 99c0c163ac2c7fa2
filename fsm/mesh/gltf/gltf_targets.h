#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fsm/mesh/gltf/gltf_document.h"
#include "fsm/mesh/gltf/vrm_avatar.h"
#include "fsm/mesh/imported_head.h"

namespace fsm {

/// The indices of a mesh, its node and its skin in a glTF file.
struct GltfMeshInstance {
  std::int64_t mesh, node, skin;
};

/// Throws for positions beyond kMaxReach; `what` is the subject of the sentence.
[[noreturn]] void RefuseReach(const std::string& what);
/// Throws for a file with more data than the limits allow.
[[noreturn]] void RefuseSize();
std::string VertexName(const GltfMeshInstance& instance, std::size_t vertex);

/// Makes the shapes of a head from the morph targets of its file, and from VRM expressions, which
/// are weighted sums of targets. Throws vm::Failure.
class GltfTargets {
 public:
  /// Lifetime: `document` and `head` outlive this.
  GltfTargets(const GltfDocument& document, ImportedHead& head)
      : document_(document), head_(head) {}
  /// Adds the targets of a primitive whose vertices are the head's from `first` on; `transforms`
  /// has a matrix for each. `names`: those of the mesh's targets; targets of the same name in
  /// different meshes form one shape.
  void Read(const nlohmann::json& primitive, const GltfMeshInstance& instance,
            std::span<const glm::mat4> transforms, std::size_t first,
            const std::vector<std::string>& names);
  /// Adds a shape named vrmNAME, made from targets read before.
  void AddExpression(const VrmAvatar::Expression& expression);

 private:
  /// The deltas of a shape, first..end, that come from one morph target.
  struct Moved {
    std::size_t shape;
    std::int64_t node;
    std::size_t first, end;
  };
  void AddBind(ImportedHead::Shape& shape, const VrmAvatar::Bind& bind);

  const GltfDocument& document_;
  ImportedHead& head_;
  std::map<std::string, std::size_t> shape_of_;                               // by name
  std::map<std::pair<std::int64_t, std::size_t>, std::vector<Moved>> moved_;  // by mesh and target
  std::size_t deltas_ = 0;
};

}  // namespace fsm
