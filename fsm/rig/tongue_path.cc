#include "fsm/rig/tongue_path.h"

#include <algorithm>
#include <glm/common.hpp>

#include "fsm/base/smooth_step.h"
#include "fsm/rig/step_constants.h"

namespace fsm {
using namespace step;

// Twin: STEP_tongue in fsm/render/shaders/rig_steps.glsl.

TonguePath::TonguePath(const Pose& pose, const ToothArch& upper, const ToothArch& lower,
                       std::span<const std::pair<std::uint32_t, std::uint32_t>> seam,
                       std::span<const glm::vec3> skin)
    : pose_(pose), upper_(upper), lower_(lower) {
  const glm::vec3 edge = TurnJaw({0, lower.edge_y, lower.front_z}, pose, 1);
  teeth_low_ = edge.y;
  teeth_high_ = upper.edge_y;
  front_z_ = std::max(upper.front_z, edge.z);
  float lips = 0;
  for (const auto& [above, below] : seam) {
    lips_.push_back({skin[above], skin[below]});
    const float gap = skin[above].y - skin[below].y;
    lips = std::max(
        lips, std::min(gap, std::min(skin[above].y - teeth_low_, teeth_high_ - skin[below].y)));
    if (gap <= kTongueNoRoom) continue;
    open_from_ = std::min(open_from_, skin[above].x);
    open_to_ = std::max(open_to_, skin[above].x);
  }
  share_ = SmoothStep(kTongueNoRoom, kTongueRoom, std::min(lips, teeth_high_ - teeth_low_));
}

TonguePath::Gap TonguePath::LipsAt(float x) const {
  const auto right = std::ranges::lower_bound(lips_, x, {}, [](const Gap& g) { return g.high.x; });
  if (right == lips_.begin()) return lips_.front();
  if (right == lips_.end()) return lips_.back();
  const Gap& b = *right;
  const Gap& a = *(right - 1);
  const float t = (x - a.high.x) / std::max(b.high.x - a.high.x, 1e-3f);
  return {glm::mix(a.high, b.high, t), glm::mix(a.low, b.low, t)};
}

glm::vec3 TonguePath::Fit(glm::vec3 p) const {
  if (lips_.empty()) return p;
  const float jaw_x = p.x - pose_.jaw.sway_mm;
  const float lower_z = TurnJaw({jaw_x, lower_.edge_y, lower_.At(jaw_x)}, pose_, 1).z;
  const glm::vec3 within(p.x, p.y, std::min(p.z, std::min(lower_z, upper_.At(p.x)) - kBehindTeeth));
  const float out = SmoothStep(0, kTongueOut, share_ * pose_.tongue_out_mm);
  if (out <= 0) return within;
  const float middle_x = 0.5f * (open_from_ + open_to_);
  const float width =
      std::min(kTongueInArch, kTongueInLips * (open_to_ - open_from_)) / kTongueWidest;
  const float squeezed = SmoothStep(front_z_ - kTongueWide, front_z_ - kTongueNarrow, p.z);
  p.x += squeezed * (middle_x + std::min(1.0f, width) * p.x - p.x);
  const Gap lips = LipsAt(p.x);
  // Over the lower teeth and lip, under the upper ones, and no less so a little before and behind
  // them, as its surface is made of triangles. Lips come last: they are seen.
  const auto held = [&p](float z) {
    return SmoothStep(z - kTongueFree, z - kTongueHeld, p.z) *
           SmoothStep(z + kTongueFree, z + kTongueHeld, p.z);
  };
  const auto above = [&](float z, float y) { p.y += held(z) * std::max(0.0f, y - p.y); };
  const auto below = [&](float z, float y) { p.y += held(z) * std::min(0.0f, y - p.y); };
  above(lower_z, teeth_low_ + kTongueEdges);
  below(upper_.At(p.x), teeth_high_ - kTongueEdges);
  const float middle_y = 0.5f * (lips.low.y + lips.high.y);
  above(lips.low.z, std::min(lips.low.y + kTongueSkin, middle_y));
  below(lips.high.z, std::max(lips.high.y - kTongueSkin, middle_y));
  return glm::mix(within, p, out);
}

}  // namespace fsm
