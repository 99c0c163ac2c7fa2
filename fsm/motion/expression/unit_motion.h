#pragma once

#include <map>
#include <string_view>

#include "fsm/motion/base/motion_source.h"
#include "fsm/motion/base/unit_names.h"

namespace fsm {

/// Moves the face by action units and by the codes of head and eyes (HeadEyeCode), on the layer
/// `units`.
/// Lifetime: `names` outlives this. Errors: kBadValue, see ParseUnitCommand.
class UnitMotion : public MotionSource {
 public:
  explicit UnitMotion(const UnitNames& names) : names_(names) {}

  /// Sets the units of a command, see ParseUnitCommand.
  vm::Result<void> Set(vm::Time now, std::string_view text);
  /// Sets a unit on both sides within 60 ms, as Face.N does.
  void Set(vm::Time now, int unit, double strength);

  void Contribute(vm::Time t, MotionLayers& layers) const override;

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override;

 private:
  void SetOne(vm::Time now, const UnitSetting& unit, vm::Time move);

  const UnitNames& names_;
  // The units and codes set so far, by number. A code has one strength for both sides.
  std::map<int, Sided<Track<float>>> tracks_;
};

}  // namespace fsm
