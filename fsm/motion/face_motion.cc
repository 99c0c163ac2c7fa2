#include "fsm/motion/face_motion.h"

#include <algorithm>
#include <cassert>

#include "fsm/motion/base/motion_errors.h"
#include "fsm/motion/speech/speech_timing.h"

namespace fsm {

// ---- commands that concern more than one source

vm::Result<void> FaceMotion::SetListedUnit(vm::Time now, int position, double strength) {
  if (auto fits = CheckStrength(strength); !fits) return fits;
  const std::vector<FaceSlot>& slots = inputs_.tables.unit_list.face_slots;
  const auto index = static_cast<std::size_t>(position - 1);
  if (position >= 1 && index < slots.size()) {
    const auto& [unit, emotion] = slots[index];
    if (unit > 0) {
      action_units.Set(now, unit, strength);
      return {};
    }
    if (inputs_.expressions.all().contains(emotion)) {
      expression.SetEmotion(now, index, strength);
      return {};
    }
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("position {} of the list of units is {}, which is no emotion of "
                                "the tables",
                                position, emotion));
  }
  return vm::Fail(vm::Errc::kBadValue,
                  fmt::format("the list of units has no position {}", position));
}

vm::Result<void> FaceMotion::PlayMovement(vm::Time now, std::string_view kind, int pattern,
                                          double strength, int count) {
  if (kind == "SHAKE") kind = "REFUSE";
  if (kind == "TILT") kind = "LISTEN";
  if (!(strength >= 0 && strength <= 3) || count < 1 || count > 20) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("{:g} times the size and {} times found; 0 to 3 and 1 to 20 expected", strength,
                    count));
  }
  if (kind != "BLINK") return head.Play(now, kind, pattern, strength, count);
  const std::size_t patterns = inputs_.tables.motions.blinks.size();
  if (auto fits = CheckPatternNumber(kind, pattern, 1, patterns); !fits) return fits;
  eyes.Blink(now, static_cast<std::size_t>(pattern), count);
  return {};
}

void FaceMotion::StopMovements(vm::Time now) {
  head.StopMovements(now);
  eyes.StopBlinks();
}

void FaceMotion::SetVisemes(VisemeSetId set, Visemes visemes) {
  Visemes& own = inputs_.tables.set(set).visemes;
  assert(visemes.size() == own.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    const float contact = own[i].pose.contact;
    own[i].pose = visemes[i].pose;
    own[i].pose.contact = contact;
    own[i].hold = visemes[i].hold;
  }
}

void FaceMotion::Apply(vm::Time now, const MotionSettings& settings) {
  const MotionSettings before = std::exchange(inputs_.settings, settings);
  const double lead_ms = settings.lead_ms - settings.offset_ms;
  if (lead_ms != before.lead_ms - before.offset_ms) speech.MoveLead(now, lead_ms);
  if (settings.mouth_scale != before.mouth_scale) {
    inputs_.mouth_scale.MoveTo(now, static_cast<float>(settings.mouth_scale), kMouthScaleMove);
  }
}

// ---- all sources together

FaceState FaceMotion::StateAt(vm::Time t) const {
  MotionLayers layers;
  for (const MotionSource* source : sources_) source->Contribute(t, layers);
  FaceState state;
  state.asymmetry = asymmetry;
  state.figure = figure;
  inputs_.tables.mixer.Mix(layers, inputs_.tables.unit_list.regions, state);
  return state;
}

std::optional<vm::Time> FaceMotion::NextMotion(vm::Time t) const {
  std::optional<vm::Time> next;
  for (const MotionSource* source : sources_) next = Earlier(next, source->NextMotion(t));
  return next;
}

vm::Time FaceMotion::SettledAt(vm::Time t) const {
  vm::Time settled = t;
  for (const MotionSource* source : sources_) settled = std::max(settled, source->SettledAt(t));
  return settled;
}

vm::Time FaceMotion::EndsAt(vm::Time t) const {
  vm::Time end = t;
  for (const MotionSource* source : sources_) end = std::max(end, source->EndsAt(t));
  return end;
}

FaceState SettledAfter(const MotionTables& tables,
                       const std::function<void(FaceMotion&)>& command) {
  constexpr vm::Time kSettled =
      std::chrono::seconds(5);  // longer than any onset of the built-in tables
  FaceMotion motion(tables, 1);
  command(motion);
  return motion.StateAt(kSettled);
}

}  // namespace fsm
