#include "fsm/rig/rig_data.h"

#include <type_traits>
#include <utility>

namespace fsm {

std::vector<std::uint32_t> StepVertices(const RigData& data) {
  std::vector<std::uint32_t> vertices;
  for (const auto& [upper, lower] : data.mouth.seam)
    vertices.insert(vertices.end(), {upper, lower});
  if (const auto& corners = data.mouth.corners)
    vertices.insert(vertices.end(), {corners->right, corners->left});
  if (!data.rest.empty()) vertices.push_back(data.jaw.chin);
  return vertices;
}

RigData OnlyVertices(const RigData& data, std::span<const std::uint32_t> vertices) {
  constexpr std::uint32_t kLeftOut = ~0u;
  std::vector<std::uint32_t> now(data.rest.size(), kLeftOut);  // new index by old index
  for (std::uint32_t i = 0; i < vertices.size(); ++i) now[vertices[i]] = i;
  const auto chosen = [&](const auto& all) {
    std::remove_cvref_t<decltype(all)> some;
    if (all.empty()) return some;
    for (const std::uint32_t vertex : vertices) some.push_back(all[vertex]);
    return some;
  };
  const auto keep = [&now](auto& items) {
    std::erase_if(items, [&](const auto& item) { return now[item.vertex] == kLeftOut; });
    for (auto& item : items) item.vertex = now[item.vertex];
  };
  RigData some = data;
  some.rest = chosen(data.rest);
  some.rest_normal = chosen(data.rest_normal);
  some.proxy = {chosen(data.proxy.rest), chosen(data.proxy.to_own)};
  some.bone = chosen(data.bone);
  some.weights = chosen(data.weights);
  some.normals = {};
  for (Channel& channel : some.channels) keep(channel.moves);
  keep(some.lids.vertices);
  keep(some.ball_lids);
  keep(some.lips.followers);
  keep(some.teeth.contacts);
  keep(some.spring_rig.weights);
  for (auto& [upper, lower] : some.mouth.seam) upper = now[upper], lower = now[lower];
  if (auto& corners = some.mouth.corners) corners = {now[corners->right], now[corners->left]};
  some.mouth.incisors.reset();  // only the renderer needs them
  if (!data.rest.empty()) some.jaw.chin = now[data.jaw.chin];
  return some;
}

RigData MakeStillRig(std::vector<glm::vec3> position, std::vector<glm::vec3> normal) {
  RigData rig;
  rig.bone.assign(position.size(), Bone::kSkull);
  rig.weights.resize(position.size());
  rig.rest = std::move(position);
  rig.rest_normal = std::move(normal);
  return rig;
}

}  // namespace fsm
