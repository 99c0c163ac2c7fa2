#pragma once

#include <string_view>

#include "fsm/motion/base/motion_source.h"
#include "fsm/motion/inputs/motion_patterns.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Shows a mood, a slight expression set by another program (such as vdm, from a voice), on the
/// layer `mood`. Expressions override it (tables/mixing.txt), so that it never competes with a
/// command. Lifetime: `patterns` outlives this. Errors: kBadValue listing what exists.
class MoodMotion : public MotionSource {
 public:
  static constexpr vm::Time kTakes{1'200'000};  ///< the time of a change of mood

  explicit MoodMotion(const MotionPatterns& patterns) : patterns_(patterns) {}
  /// Shows a mood of MotionPatterns::moods, or none (NEUTRAL); `strength`: 1 = full.
  vm::Result<void> Set(vm::Time now, std::string_view name, double strength);
  void Contribute(vm::Time t, MotionLayers& layers) const override;

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override { visit(look_); }

 private:
  const MotionPatterns& patterns_;
  Track<FaceLook> look_;
};

}  // namespace fsm
