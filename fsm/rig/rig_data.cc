#include "fsm/rig/rig_data.h"

#include <glm/geometric.hpp>
#include <map>
#include <utility>

namespace fsm {

std::vector<Channel> UnitChannels(const UnitTable& units, std::span<const Bone> bones,
                                  std::span<const SkinWeights> weights) {
  constexpr float kLeast = 1e-3f;  // millimetres
  std::vector<Channel> channels;
  for (std::uint8_t side = 0; side < 2; ++side) {
    std::map<int, std::vector<glm::vec3>> sums;  // of each unit, by vertex
    for (const UnitTable::Field& field : units.fields()) {
      auto& sum = sums[field.unit];
      sum.resize(weights.size(), glm::vec3(0));
      for (std::size_t i = 0; i < weights.size(); ++i) {
        if (bones[i] == Bone::kSkin) sum[i] += UnitTable::Motion(field, weights[i], side == 0);
      }
    }
    for (const auto& [unit, sum] : sums) {
      Channel channel;
      channel.drivers.push_back({{.kind = Drive::Kind::kUnit,
                                  .number = static_cast<std::uint16_t>(unit),
                                  .side = static_cast<Drive::Side>(side)}});
      for (std::uint32_t i = 0; i < sum.size(); ++i) {
        if (glm::length(sum[i]) > kLeast) channel.moves.push_back({i, sum[i]});
      }
      channels.push_back(std::move(channel));
    }
  }
  return channels;
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
