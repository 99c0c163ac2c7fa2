#include "fsm/asset/check_asset.h"

#include <fmt/format.h>

#include <string>

#include "fsm/rig/rig_steps.h"
#include "fsm/rig/vertex_checker.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

void CheckTopology(const HeadTopology& topology, const VertexChecker& checker) {
  checker.Triangles(topology.indices, "topology.indices");
  for (std::size_t i = 0; i < topology.parts.size(); ++i) {
    const HeadTopology::Part& part = topology.parts[i];
    const std::string place = checker.Element("topology.parts", i);
    if (part.index_count % 3 != 0 || part.first_index > topology.indices.size() ||
        part.index_count > topology.indices.size() - part.first_index) {
      checker.Refuse(place + ": its triangles are not among the indices");
    }
    if (part.pbr < -1 || part.pbr >= static_cast<int>(topology.pbr_materials.size())) {
      checker.Refuse(
          fmt::format("{}: PBR material {} of {}", place, part.pbr, topology.pbr_materials.size()));
    }
  }
  checker.PerVertex(topology.albedo.size(), "topology.albedo");
  checker.PerVertex(topology.openness.size(), "topology.openness");
  checker.PerVertex(topology.opacity.size(), "topology.opacity", true);
  checker.PerVertex(topology.uv.size(), "topology.uv", true);
  checker.PerVertex(topology.strands.size(), "topology.strands", true);
  checker.PerVertex(topology.textures.texcoord.size(), "topology.texcoord",
                    !topology.textures.image);
  checker.PerVertex(topology.textures.weight.size(), "topology.texture_weight",
                    !topology.textures.image);
  checker.VerticesOf(topology.portrait.shut_lids, "topology.shut_lids");
  checker.PerVertex(topology.portrait.relit.size(), "topology.relit", true);
  const MouthSlit& mouth = topology.mouth;
  checker.Pairs(mouth.seam, "topology.mouth.seam");
  for (const auto vertex : {mouth.corner_right, mouth.corner_left, mouth.upper_incisor,
                            mouth.lower_incisor, mouth.upper_root}) {
    checker.Vertex(vertex, "topology.mouth");
  }
}

}  // namespace

vm::Result<void> CheckAsset(const HeadAsset& asset) {
  try {
    const VertexChecker checker(asset.rig.rest.size());
    if (checker.vertices() == 0) checker.Refuse("rig.rest: no vertices");
    CheckTopology(asset.topology, checker);
    CheckRig(asset.rig);
    if (asset.view) checker.Positive(asset.view->half_mm, "view.half_mm");
  } catch (const vm::Failure& failure) {
    return std::unexpected(failure.error);
  }
  return {};
}

}  // namespace fsm
