#include "fsm/app/mouth_stream_slots.h"

#include <cmath>

#include "vm_protocol/core/start_time.h"

namespace fsm {
namespace {

constexpr std::size_t kValues = 1 + kMouthParameters + 2;
constexpr std::size_t kHeadValues = 4;
constexpr double kMaxDegrees = 90;

vm::Result<MouthPose> PoseOf(const vm::SetValue& value) {
  if (value.size() != kValues && value.size() != kValues + kHeadValues) {
    return vm::Fail(vm::Errc::kBadValue,
                    std::to_string(value.size()) + " numbers found, " + std::to_string(kValues) +
                        " expected: ms, 17 mouth parameters, seal, tongue; or " +
                        std::to_string(kValues + kHeadValues) +
                        ": then the head's angles down, right, tilt, and the brows");
  }
  std::vector<std::string> words;
  for (std::size_t i = 1; i < kValues; ++i) words.push_back(value.word(i));
  Viseme shape;
  if (auto read = ReadVisemeValues(words, 0, shape); !read) return std::unexpected(read.error());
  shape.pose.contact = shape.pose.seal;
  return shape.pose;
}

/// Returns head and brows of a value that PoseOf accepts; nothing if the value does not have them.
vm::Result<std::optional<StreamHead>> HeadOf(const vm::SetValue& value) {
  if (value.size() == kValues) return std::nullopt;
  StreamHead head;
  for (std::size_t i = 0; i < head.angles.size(); ++i) {
    const double angle = value.number(kValues + i);
    if (!(std::abs(angle) <= kMaxDegrees)) {
      return vm::Fail(vm::Errc::kBadValue, "an angle of the head is " + value.word(kValues + i) +
                                               ", -90 to 90 degrees expected");
    }
    head.angles[i] = static_cast<float>(angle);
  }
  const double brow = value.number(kValues + 3);
  if (!(brow >= 0 && brow <= 1)) {
    return vm::Fail(vm::Errc::kBadValue,
                    "the brows are " + value.word(kValues + 3) + ", 0 to 1 expected");
  }
  head.brow = static_cast<float>(brow);
  return head;
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
       .on_set_later = core.CommandLater([&core](const vm::SetValue& value) -> vm::Result<void> {
         if (value.word(0) == "STOP") {
           core.motion->mouth_stream.Stop(core.Now());
           return {};
         }
         const auto time = vm::ParseStartTime(value.text);
         if (!time) return std::unexpected(time.error());
         core.motion->mouth_stream.set_start(core.InstantOf(*time));
         return {};
       })});
  core.slots.Declare(
      {.name = "MouthFrame",
       .grammar = "<number>...",
       .access = vm::Access::kWriteOnly,
       .help =
           "The mouth at one instant, from outside: MS after MouthFrame.start, then as in "
           "MouthShape 17 mouth parameters (full articulation; MouthScale applies), SEAL, TONGUE; "
           "and if wanted what head and brows do with it: DOWN RIGHT TILT in degrees, BROW 0 to 1. "
           "Between frames up to 200 ms apart the face moves; when none come the mouth closes and "
           "the head goes home.",
       .on_set_later = core.CommandLater([&core](const vm::SetValue& value) -> vm::Result<void> {
         const auto pose = PoseOf(value);
         if (!pose) return std::unexpected(pose.error());
         const auto head = HeadOf(value);
         if (!head) return std::unexpected(head.error());
         const vm::Time at = core.motion->mouth_stream.start() + FromMs(value.number(0));
         return core.motion->mouth_stream.Add(core.Now(), at, *pose, *head);
       })});
}

}  // namespace fsm
