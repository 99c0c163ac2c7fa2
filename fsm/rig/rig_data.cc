#include "fsm/rig/rig_data.h"

#include <glm/geometric.hpp>
#include <map>
#include <type_traits>
#include <utility>

namespace fsm {

std::vector<Channel> UnitChannels(const UnitTable& units, std::span<const Bone> bones,
                                  std::span<const SkinWeights> weights) {
  constexpr float kLeast = 1e-3f;  // millimetres
  std::vector<Channel> channels;
  for (const Side side : kSides) {
    std::map<int, std::vector<glm::vec3>> sums;  // of each unit, by vertex
    for (const UnitTable::Field& field : units.fields()) {
      auto& sum = sums[field.unit];
      sum.resize(weights.size(), glm::vec3(0));
      for (std::size_t i = 0; i < weights.size(); ++i) {
        if (bones[i] == Bone::kSkin) sum[i] += UnitTable::Motion(field, weights[i], side);
      }
    }
    for (const auto& [unit, sum] : sums) {
      Channel channel;
      channel.drivers.push_back({{.kind = Drive::Kind::kUnit,
                                  .number = static_cast<std::uint16_t>(unit),
                                  .side = Drive::OnlyOf(side)}});
      for (std::uint32_t i = 0; i < sum.size(); ++i) {
        if (glm::length(sum[i]) > kLeast) channel.moves.push_back({i, sum[i]});
      }
      channels.push_back(std::move(channel));
    }
  }
  return channels;
}

std::vector<std::uint32_t> StepVertices(const RigData& data) {
  std::vector<std::uint32_t> vertices;
  for (const auto& [upper, lower] : data.lips.seam) vertices.insert(vertices.end(), {upper, lower});
  if (data.lips.measured)
    vertices.insert(vertices.end(), data.lips.measured->begin(), data.lips.measured->end());
  if (!data.rest.empty()) vertices.push_back(data.chin);
  return vertices;
}

RigData OnlyVertices(const RigData& data, std::span<const std::uint32_t> vertices) {
  constexpr std::uint32_t kLeftOut = ~0u;
  std::vector<std::uint32_t> now(data.rest.size(), kLeftOut);  // by the vertex before
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
  some.proxy_rest = chosen(data.proxy_rest);
  some.own_form = chosen(data.own_form);
  some.bone = chosen(data.bone);
  some.weights = chosen(data.weights);
  some.soft_triangles.clear();
  some.normal_twin.clear();
  for (Channel& channel : some.channels) keep(channel.moves);
  keep(some.lids.vertices);
  keep(some.ball_lids);
  keep(some.lips.followers);
  keep(some.teeth_contacts);
  keep(some.spring_weights);
  for (auto& [upper, lower] : some.lips.seam) upper = now[upper], lower = now[lower];
  if (some.lips.measured) {
    for (std::uint32_t& vertex : *some.lips.measured) vertex = now[vertex];
  }
  if (!data.rest.empty()) some.chin = now[data.chin];
  return some;
}

RigData StillRig(std::vector<glm::vec3> position, std::vector<glm::vec3> normal) {
  RigData rig;
  rig.bone.assign(position.size(), Bone::kSkull);
  rig.weights.resize(position.size());
  rig.rest = std::move(position);
  rig.rest_normal = std::move(normal);
  return rig;
}

}  // namespace fsm
