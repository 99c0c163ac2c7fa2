#include "fsm/asset/check_asset.h"

#include <fmt/format.h>

#include <string>

#include "fsm/rig/rig_steps.h"
#include "fsm/rig/vertex_checker.h"

namespace fsm {
namespace {

void CheckSurface(const HeadSurface& surface, const VertexChecker& checker) {
  checker.Triangles(surface.indices, "surface.indices");
  for (std::size_t i = 0; i < surface.parts.size(); ++i) {
    const HeadSurface::Part& part = surface.parts[i];
    const std::string place = checker.Element("surface.parts", i);
    if (part.index_count % 3 != 0 || part.first_index > surface.indices.size() ||
        part.index_count > surface.indices.size() - part.first_index) {
      checker.Refuse(place + ": its triangles are not among the indices");
    }
    if (part.pbr < -1 || part.pbr >= static_cast<int>(surface.pbr_materials.size())) {
      checker.Refuse(
          fmt::format("{}: PBR material {} of {}", place, part.pbr, surface.pbr_materials.size()));
    }
  }
  checker.PerVertex(surface.albedo.size(), "surface.albedo");
  checker.PerVertex(surface.openness.size(), "surface.openness");
  checker.EmptyOrPerVertex(surface.opacity.size(), "surface.opacity");
  checker.EmptyOrPerVertex(surface.uv.size(), "surface.uv");
  checker.EmptyOrPerVertex(surface.strands.size(), "surface.strands");
  const auto check =
      surface.textures.base_colour ? &VertexChecker::PerVertex : &VertexChecker::EmptyOrPerVertex;
  (checker.*check)(surface.textures.texcoord.size(), "surface.texcoord");
  (checker.*check)(surface.textures.weight.size(), "surface.texture_weight");
  checker.VerticesOf(surface.portrait.shut_lids, "surface.shut_lids");
  checker.EmptyOrPerVertex(surface.portrait.relit.size(), "surface.relit");
}

}  // namespace

void CheckAsset(const HeadAsset& asset) {
  const VertexChecker checker(asset.rig.rest.size());
  if (checker.vertices() == 0) checker.Refuse("rig.rest: no vertices");
  CheckSurface(asset.surface, checker);
  CheckRig(asset.rig);
  if (asset.view) checker.Positive(asset.view->half_mm, "view.half_mm");
}

}  // namespace fsm
