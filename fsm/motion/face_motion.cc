#include "fsm/motion/face_motion.h"

#include <algorithm>
#include <cassert>

#include "fsm/motion/base/motion_errors.h"

namespace fsm {

// ---- commands that concern more than one source

vm::Result<void> FaceMotion::SetFace(vm::Time now, int position, double strength) {
  if (auto fits = CheckStrength(strength); !fits) return fits;
  const UnitList& list = inputs_.tables.units;
  const auto index = static_cast<std::size_t>(position - 1);
  if (position >= 1 && index < list.units.size()) {
    if (list.units[index] > 0) {
      units.Set(now, list.units[index], strength);
      return {};
    }
    if (inputs_.tables.expressions.contains(list.emotions[index])) {
      expression.SetEmotion(now, index, strength);
      return {};
    }
    return vm::Fail(vm::Errc::kBadValue,
                    fmt::format("position {} of the list of units is {}, which is no emotion of "
                                "the tables",
                                position, list.emotions[index]));
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
  speech.Adjust(now, settings);
  if (settings.mouth_scale != inputs_.settings.mouth_scale) {
    mouth_stream.SetMouthScale(now, settings.mouth_scale);
  }
  inputs_.settings = settings;
}

// ---- all sources together

FaceState FaceMotion::StateAt(vm::Time t) const {
  MotionLayers layers;
  for (const MotionSource* source : sources_) source->Contribute(t, layers);
  FaceState state;
  state.asymmetry = asymmetry;
  state.figure = figure;
  inputs_.tables.mixer.Mix(layers, inputs_.tables.units, state);
  return state;
}

std::optional<vm::Time> FaceMotion::NextActivity(vm::Time t) const {
  std::optional<vm::Time> next;
  for (const MotionSource* source : sources_) next = Earlier(next, source->NextActivity(t));
  return next;
}

vm::Time FaceMotion::OnsetsSettled(vm::Time t) const {
  vm::Time settled = t;
  for (const MotionSource* source : sources_) settled = std::max(settled, source->SettledAt(t));
  return settled;
}

vm::Time FaceMotion::FiniteEnd(vm::Time t) const {
  vm::Time end = t;
  for (const MotionSource* source : sources_) end = std::max(end, source->FiniteEnd(t));
  return end;
}

}  // namespace fsm
