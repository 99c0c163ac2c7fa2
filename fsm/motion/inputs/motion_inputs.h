#pragma once

#include <cstdint>
#include <utility>

#include "fsm/motion/base/track.h"
#include "fsm/motion/inputs/expression_store.h"
#include "fsm/motion/inputs/idle_switches.h"
#include "fsm/motion/inputs/motion_settings.h"
#include "fsm/motion/inputs/motion_tables.h"

namespace fsm {

/// What the sources of a FaceMotion have in common: they refer to this and not to each other.
/// Commands change settings, switches, expressions and visemes.
struct MotionInputs {
  MotionInputs(MotionTables all, std::uint64_t of_random)
      : tables(std::move(all)), seed(of_random) {}
  MotionInputs(const MotionInputs&) = delete;  // all members refer to the tables

  MotionTables tables;
  ExpressionStore expressions{tables};
  MotionSettings settings;
  Track<float> mouth_scale{static_cast<float>(settings.mouth_scale)};  ///< without its jumps
  IdleSwitches switches{tables.motions};
  const std::uint64_t seed;  ///< of everything random
};

}  // namespace fsm
