#include "fsm/motion/expression/unit_motion.h"

#include "fsm/motion/base/layer_names.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr vm::Time kUnitMove = 60ms;   // units set without a time
constexpr vm::Time kCodeMove = 120ms;  // heads and eyes take longer than skin

}  // namespace

void UnitMotion::SetOne(vm::Time now, const UnitSetting& unit, vm::Time move) {
  auto& track = tracks_[unit.number];
  for (const Side side : kSides) {
    if (unit.sides[side]) track[side].MoveTo(now, static_cast<float>(unit.strength), move);
  }
}

vm::Result<void> UnitMotion::Set(vm::Time now, std::string_view text) {
  const auto command = ParseUnitCommand(text, names_);
  if (!command) return std::unexpected(command.error());
  for (const UnitSetting& one : command->settings) {
    const vm::Time usual = names_.IsUnit(one.number) ? kUnitMove : kCodeMove;
    SetOne(now, one, command->ms ? FromMs(*command->ms) : usual);
  }
  return {};
}

void UnitMotion::Set(vm::Time now, int unit, double strength) {
  UnitSetting setting{{.number = unit}, strength};
  KeepOwnSide(setting, names_);
  SetOne(now, setting, kUnitMove);
}

void UnitMotion::Contribute(vm::Time t, MotionLayers& layers) const {
  MotionLayer& layer = layers.Layer(LayerName::kUnits);
  for (const auto& [number, track] : tracks_) {
    const auto found = names_.codes.find(number);
    if (found == names_.codes.end()) {
      for (const Side side : kSides) {
        layer.look.au[side][static_cast<std::size_t>(number)] = track[side].At(t);
      }
      continue;
    }
    const float strength = track.left.At(t);
    const HeadEyeCode& code = found->second;
    for (std::size_t i = 0; i < 3; ++i) layer.head_rotation[i] += strength * code.head_rotation[i];
    for (const Side side : kSides) {
      for (std::size_t i = 0; i < 2; ++i) {
        layer.look.gaze[side][i] += strength * code.gaze[side][i];
      }
    }
    layer.head_forward_mm += strength * code.head_forward_mm;
  }
}

void UnitMotion::ForEachTrack(const TrackVisitor& visit) const {
  for (const auto& [number, track] : tracks_) {
    for (const Side side : kSides) visit(track[side]);
  }
}

}  // namespace fsm
