#include <cmath>

#include "fsm/app/slot_groups.h"
#include "vm_protocol/core/start_time.h"

namespace fsm {
namespace {

constexpr double kMostMm = 60;  // as in the tables of mouth shapes
constexpr std::size_t kValues = 1 + kMouthParameters + 2;

vm::Result<MouthPose> PoseOf(const vm::SetValue& value) {
  if (value.size() != kValues) {
    return vm::Fail(vm::Errc::kBadValue, std::to_string(value.size()) + " numbers found, " +
                                             std::to_string(kValues) +
                                             " expected: ms, 17 mouth parameters, seal, tongue");
  }
  MouthPose pose;
  for (std::size_t i = 0; i < kMouthParameters; ++i) {
    if (!(std::abs(value.number(i + 1)) <= kMostMm)) {
      return vm::Fail(vm::Errc::kBadValue, "mouth parameter " + std::to_string(i + 1) + " is " +
                                               value.word(i + 1) + ", -60 to 60 expected");
    }
    pose.mouth[i] = static_cast<float>(value.number(i + 1));
  }
  const double seal = value.number(kMouthParameters + 1),
               tongue = value.number(kMouthParameters + 2);
  if (!(seal >= 0 && seal <= 1 && tongue >= 0 && tongue <= 1)) {
    return vm::Fail(vm::Errc::kBadValue, "seal and tongue are " + value.word(kMouthParameters + 1) +
                                             " and " + value.word(kMouthParameters + 2) +
                                             ", 0 to 1 expected");
  }
  pose.seal = static_cast<float>(seal);
  pose.tongue = static_cast<float>(tongue);
  pose.contact = pose.seal;
  return pose;
}

}  // namespace

void DeclareMouthStreamSlots(FsmCore& core) {
  core.slots.Declare(
      {.name = "MouthFrame.start",
       .grammar = "NOW | STOP | <time>",
       .access = vm::Access::kWriteOnly,
       .help =
           "From when on the ms of MouthFrame count: NOW, + ms, @T (ms on the module's clock) or "
           "a wall time. STOP forgets the frames still to come: the mouth closes.",
       .on_set_later = [&core](const vm::SetValue& value, const vm::Reply& reply) {
         if (value.word(0) == "STOP") {
           core.motion->StopMouthFrames(core.Now());
           core.changed();
           return reply.Ok(value.text);
         }
         const auto time = vm::ParseStartTime(value.text);
         if (!time) return reply.Fail(time.error());
         core.motion->set_mouth_frames_start(core.InstantOf(*time));
         reply.Ok(value.text);
       }});
  core.slots.Declare(
      {.name = "MouthFrame",
       .grammar = "<number>...",
       .access = vm::Access::kWriteOnly,
       .help =
           "The mouth at one instant, from outside: MS after MouthFrame.start, then as in "
           "MouthShape 17 mouth parameters (full articulation; MouthScale applies), SEAL, TONGUE. "
           "Between frames up to 200 ms apart the mouth moves; when none come it closes.",
       .on_set_later = [&core](const vm::SetValue& value, const vm::Reply& reply) {
         const auto pose = PoseOf(value);
         if (!pose) return reply.Fail(pose.error());
         const vm::Time at = core.motion->mouth_frames_start() + FromMs(value.number(0));
         if (auto added = core.motion->AddMouthFrame(core.Now(), at, *pose); !added) {
           return reply.Fail(added.error());
         }
         core.changed();
         reply.Ok(value.text);
       }});
}

}  // namespace fsm
