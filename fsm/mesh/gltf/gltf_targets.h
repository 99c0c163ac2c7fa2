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

/// Where something of a glTF file stands: indices of its mesh, node and skin.
struct GltfPlace {
  std::int64_t mesh, node, skin;
};

/// What a reader of a glTF file throws, as vm::Failure.
[[noreturn]] void Refuse(const GltfDocument& document, const std::string& what);
/// Of what lies out of kMaxMeshReach; `what` is the sentence's subject.
[[noreturn]] void RefuseReach(const GltfDocument& document, const std::string& what);
[[noreturn]] void RefuseSize(const GltfDocument& document);  ///< more than is read
std::string VertexAt(const GltfPlace& place, std::size_t vertex);

/// Makes shapes of a head of the morph targets of its file, and of VRM's expressions, which are
/// weighted sums of targets. What is wrong is thrown as a vm::Failure.
class GltfTargets {
 public:
  /// `document` and `head` outlive it.
  GltfTargets(const GltfDocument& document, ImportedHead& head)
      : document_(document), head_(head) {}
  /// Those of a primitive whose vertices are the head's from `first` on, each with its transform.
  /// `names`: of the mesh's targets; targets of one name, of whatever mesh, are one shape.
  void Read(const nlohmann::json& primitive, const GltfPlace& place,
            std::span<const glm::mat4> transforms, std::size_t first,
            const std::vector<std::string>& names);
  /// A shape called vrmNAME of the targets read before.
  void AddExpression(const VrmAvatar::Expression& expression);

 private:
  /// What a morph target moves: vertices of a shape's.
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
