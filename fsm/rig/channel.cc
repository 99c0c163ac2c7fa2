#include "fsm/rig/channel.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "fsm/rig/pose.h"

namespace fsm {
namespace {

float ValueOf(const Drive& drive, const FaceState& state, const Pose& pose) {
  using enum Drive::Kind;
  const std::size_t number = drive.number;
  constexpr float kMaxMouth = 30;  // in millimetres, and in degrees for the jaw
  const auto whole = [&](Side side) {
    switch (drive.kind) {
      case kUnit:
        return pose.au[side][number];
      case kCommandedUnit:
        return Bound(state.au[side][number], 0, kMaxStrength);
      case kMouth:
        return pose.mouth[number];
      case kSpokenMouth:
        return Bound(state.mouth[number] - state.mouth_by_hand[number], -kMaxMouth, kMaxMouth);
      case kHandMouth:
        return Bound(state.mouth_by_hand[number], -kMaxMouth, kMaxMouth);
      case kBlink:
        return pose.blink[side];
      case kGazeUp:
        return -GazeOf(pose.eye[side])[kDown];
      case kGazeRight:
        return GazeOf(pose.eye[side])[kToRight];
      case kResidual:
        return Bound(state.residuals[number], 0, kMaxStrength);
    }
    return 0.0f;
  };
  const auto value = [&](Side side) {
    if (drive.half == Drive::Half::kWhole) return whole(side);
    return std::max(drive.half == Drive::Half::kPositive ? whole(side) : -whole(side), 0.0f);
  };
  if (drive.side == Drive::WhichSide::kStronger) {
    return std::max(value(Side::kRight), value(Side::kLeft));
  }
  return value(drive.side == Drive::WhichSide::kRight ? Side::kRight : Side::kLeft);
}

}  // namespace

std::vector<Channel> UnitChannels(const UnitTable& units, std::span<const Bone> bones,
                                  std::span<const SkinWeights> weights) {
  constexpr float kMin = 1e-3f;                         // smaller displacements (mm) are dropped
  std::map<int, std::vector<UnitTable::Field>> fields;  // by unit
  for (const UnitTable::Field& field : units.fields()) fields[field.unit].push_back(field);
  std::vector<Channel> channels;
  std::vector<glm::vec3> sum;  // by vertex
  for (const Side side : kSides) {
    for (const auto& [unit, own] : fields) {
      sum.assign(weights.size(), glm::vec3(0));
      for (const UnitTable::Field& field : own) {
        for (std::size_t i = 0; i < weights.size(); ++i) {
          if (bones[i] == Bone::kSkin) sum[i] += FieldDisplacement(field, weights[i], side);
        }
      }
      Channel channel;
      channel.drivers.push_back({{.kind = Drive::Kind::kUnit,
                                  .number = static_cast<std::uint16_t>(unit),
                                  .side = Drive::OnlyOf(side)}});
      for (std::uint32_t i = 0; i < sum.size(); ++i) {
        if (glm::length(sum[i]) > kMin) channel.moves.push_back({i, sum[i]});
      }
      channels.push_back(std::move(channel));
    }
  }
  return channels;
}

ChannelStrengths::ChannelStrengths(std::span<const Channel> channels) {
  std::map<std::array<int, 4>, std::uint32_t> known;
  for (const Channel& channel : channels) {
    for (const auto& [drive, gain] : channel.drivers) {
      const std::array key{static_cast<int>(drive.kind), static_cast<int>(drive.number),
                           static_cast<int>(drive.side), static_cast<int>(drive.half)};
      const auto [at, fresh] = known.try_emplace(key, static_cast<std::uint32_t>(drives_.size()));
      if (fresh) drives_.push_back(drive);
      driver_from_.push_back(at->second);
    }
  }
}

void ChannelStrengths::ComputeStrengths(std::span<const Channel> channels, const FaceState& state,
                                        const Pose& pose, std::vector<float>& out) const {
  thread_local std::vector<float> values;  // by drive; kept from frame to frame
  values.clear();
  for (const Drive& drive : drives_) values.push_back(ValueOf(drive, state, pose));
  auto from = driver_from_.begin();
  for (const Channel& channel : channels) {
    float strength = 0;
    for (const Channel::Driver& driver : channel.drivers) strength += driver.gain * values[*from++];
    out.push_back(std::clamp(strength, channel.min, channel.max) *
                  ((1 - pose.seal) * channel.open_factor + pose.seal * channel.sealed_factor));
  }
}

}  // namespace fsm
