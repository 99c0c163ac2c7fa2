#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fsm/motion/inputs/emotion_space.h"
#include "fsm/motion/inputs/expression_table.h"
#include "vm_protocol/core/result.h"

namespace facespace {

struct SpacePlan {
  int hidden = 48;     ///< units of the layers beside the middle
  int steps = 20'000;  ///< of 96 expressions each
  double lead = 1;     ///< how strongly emotions are led to their axes beside being given back
  std::uint64_t seed = 1;
};

/// An emotion the space is built of.
struct Axis {
  std::string emotion;
  fsm::EmotionSpace::Point at{};
};
/// The table face_space/tables/axes.txt, or another of its kind: 2 to 6 rows, each emotion and each
/// place once. Errors: kBadValue "NAME:LINE: ...".
vm::Result<std::vector<Axis>> ReadAxes(const std::string& name, std::string_view text);
const std::vector<Axis>& BuiltAxes();

/// Learns the space of the patterns of these emotions, alone and blended with their neighbours (all
/// but the opposite one), at strengths from a tenth to full. The left and the right side count
/// half each; the gaze does not count. The same plan and tables give the same numbers: it computes
/// in one thread and in a fixed order. `progress` is told how much is done, 0..1, and the loss.
/// Error: kBadValue for an axis without an emotion.
vm::Result<fsm::EmotionSpace> LearnSpace(const SpacePlan& plan,
                                         const fsm::ExpressionTable& expressions,
                                         const std::vector<Axis>& axes,
                                         const std::function<void(double, double)>& progress);

/// The text of a space, as fsm::ReadEmotionSpace reads it. Weights have four digits behind the
/// point.
std::string FormatSpace(const fsm::EmotionSpace& space);

/// How a pattern of an emotion comes back through the space.
struct GivenBack {
  std::string emotion;
  int pattern = 1;
  fsm::EmotionSpace::Point at{};
  double rms = 0;    ///< over the units of the space
  double worst = 0;  ///< of one unit
};
std::vector<GivenBack> JudgeSpace(const fsm::EmotionSpace& space,
                                  const fsm::ExpressionTable& expressions,
                                  const std::vector<Axis>& axes);

/// The strengths of the space's units in a look, both sides' mean.
std::vector<float> RatiosOf(const fsm::EmotionSpace& space, const fsm::FaceLook& look);

}  // namespace facespace
