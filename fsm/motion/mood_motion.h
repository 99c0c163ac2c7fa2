#pragma once

#include <string_view>

#include "fsm/motion/motion_patterns.h"
#include "fsm/motion/motion_source.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// A mood: a slight look that another program gives and takes away (vdm, of a voice), on the layer
/// `mood`. Expressions cover it (tables/mixing.txt), so that it never competes with what somebody
/// asked for. The patterns outlive it. Errors: kBadValue with what there is.
class MoodMotion : public MotionSource {
 public:
  static constexpr vm::Time kTakes{1'200'000};  ///< from one mood to another

  explicit MoodMotion(const MotionPatterns& patterns) : patterns_(patterns) {}
  /// Shows a mood of the patterns, or NEUTRAL; `strength` 1 is full.
  vm::Result<void> Set(vm::Time now, std::string_view name, double strength);
  void Contribute(vm::Time t, MotionLayers& layers) const override;

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override { visit(look_); }

 private:
  const MotionPatterns& patterns_;
  Track<ActionUnits> look_;
};

}  // namespace fsm
