#pragma once

#include <map>
#include <string_view>

#include "fsm/motion/motion_source.h"
#include "fsm/motion/unit_names.h"

namespace fsm {

/// Action units, and codes of head and eyes, as commands set them, on the layer `units`.
/// Lifetime: the names outlive it. Errors: kBadValue, see ParseUnitCommand.
class UnitMotion : public MotionSource {
 public:
  explicit UnitMotion(const UnitNames& names) : names_(names) {}

  /// Sets one unit, `12L`; strength 0..2.
  vm::Result<void> Set(vm::Time now, std::string_view unit, double strength, vm::Time move);
  /// Sets the units that a text names, see ParseUnitCommand.
  vm::Result<void> Set(vm::Time now, std::string_view text);
  /// Sets a unit on both sides within 60 ms, as Face.N does.
  void Set(vm::Time now, int unit, double strength);

  void Contribute(vm::Time t, MotionLayers& layers) const override;

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override;

 private:
  void SetOne(vm::Time now, const UnitSetting& unit, vm::Time move);

  const UnitNames& names_;
  // The units ever set, by number. A code has one strength for both sides.
  std::map<int, Sided<Track<float>>> units_;
};

}  // namespace fsm
