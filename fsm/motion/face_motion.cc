#include "fsm/motion/face_motion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "fsm/motion/motion_errors.h"
#include "fsm/motion/random.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr vm::Time kHeadTurn = 120ms;  // quick, but not at once
constexpr vm::Time kScaleMove = 100ms;
enum Stream : std::uint64_t { kShiftBlink = 300 };

}  // namespace

FaceMotion::FaceMotion(MotionTables tables, std::uint64_t seed)
    : tables_(std::move(tables)),
      table_emotions_(tables_.emotions),
      seed_(seed),
      side_lags_(SideLagsOf(seed)),
      idle_(tables_.motions, seed),
      emotions_(tables_.units.emotions.size()) {}

// ---- eyes and head

void FaceMotion::TurnEyes(vm::Time now, bool left, bool right, double x, double y,
                          vm::Time duration) {
  eyes_.Turn(now, left, right, {static_cast<float>(x), static_cast<float>(y)}, settings_.eye_move,
             duration);
}

void FaceMotion::LookSomewhere(vm::Time now, bool user, bool think) {
  on_user_.MoveTo(now, user ? 1.0f : 0.0f, 2 * settings_.eye_move);
  thinking_.MoveTo(now, think ? 1.0f : 0.0f, settings_.eye_move);
  if (think) thinking_since_ = now;
  // Half the distance between the pupils, over the distance looked at; a thinker looks at nothing.
  constexpr double kHalfPupils = 31;
  const double near = settings_.gaze_distance_mm;
  const double angle =
      think || near <= 0 ? 0 : std::atan2(kHalfPupils, near) * 180 / std::numbers::pi;
  vergence_deg_.MoveTo(now, static_cast<float>(angle), 2 * settings_.eye_move);
}

void FaceMotion::BlinkAtShift(vm::Time now, const EyeAngles& from, const EyeAngles& to) {
  if (!idle_.On(IdleKind::kGazeBlink) || tables_.motions.blinks.empty()) return;
  const double angle = std::hypot(to[0] - from[0], to[1] - from[1]);
  // Nearly always with large shifts, seldom with small ones (Evinger et al., Not looking while
  // leaping, 1994).
  const double chance = std::clamp(angle / 20, 0.0, 0.95);
  if ((RandomAt(seed_, kShiftBlink, ++shifts_) + 1) / 2 < chance) {
    eyes_.Blink(now, tables_.motions.blinks.front());
  }
}

void FaceMotion::Gaze(vm::Time now, double x, double y, vm::Time duration) {
  const EyeAngles to = {static_cast<float>(x), static_cast<float>(y)};
  BlinkAtShift(now, eyes_.GazeTarget(now), to);
  LookSomewhere(now, false, false);
  eyes_.Gaze(now, to, settings_.eye_move, duration);
}

void FaceMotion::LookAtUser(vm::Time now) {
  const EyeAngles from = thinking_.TargetAt(now) > 0 ? EyeAngles{-5, 11} : eyes_.GazeTarget(now);
  BlinkAtShift(now, from, {0, 0});
  LookSomewhere(now, true, false);
  eyes_.Gaze(now, {0, 0}, settings_.eye_move, vm::Time(0));
}

void FaceMotion::Think(vm::Time now) {
  BlinkAtShift(now, eyes_.GazeTarget(now), {-5, 11});
  LookSomewhere(now, false, true);
  eyes_.Gaze(now, {0, 0}, settings_.eye_move, vm::Time(0));
}

void FaceMotion::TurnHead(vm::Time now, const Angles& angles) {
  head_.TurnTo(now, angles, kHeadTurn);
}

void FaceMotion::TurnHeadBy(vm::Time now, const Angles& angles) {
  head_.TurnBy(now, angles, kHeadTurn);
}

vm::Result<void> FaceMotion::Move(vm::Time now, std::string_view kind, int pattern, double strength,
                                  int count) {
  if (kind == "SHAKE") kind = "REFUSE";
  if (kind == "TILT") kind = "LISTEN";
  if (!(strength >= 0 && strength <= 3) || count < 1 || count > 20) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("{:g} times the size and {} times found; 0 to 3 and 1 to 20 expected", strength,
                    count));
  }
  if (kind == "BLINK") {
    const auto& blinks = tables_.motions.blinks;
    if (auto fits = CheckPattern(kind, pattern, 1, blinks.size()); !fits) return fits;
    const BlinkPattern& blink = blinks[static_cast<std::size_t>(pattern - 1)];
    for (int i = 0; i < count; ++i) eyes_.Blink(now + i * LengthOf(blink), blink);
    return {};
  }
  const auto found = tables_.motions.head.find(kind);
  const std::size_t patterns = found == tables_.motions.head.end() ? 0 : found->second.size();
  if (auto fits = CheckPattern(kind, pattern, 1, patterns); !fits) return fits;
  head_.Play(now, found->second[static_cast<std::size_t>(pattern - 1)], strength, count);
  return {};
}

void FaceMotion::StopMoves(vm::Time now) {
  head_.StopMoves(now);
  eyes_.StopBlinks();
}

vm::Result<void> FaceMotion::Autonomous(vm::Time now, std::string_view kind, int pattern) {
  const auto life = IdleKindNamed(kind);
  if (!life) {
    return vm::Fail(vm::Errc::kBadValue, fmt::format("'{}' is nothing the face does by itself; {} "
                                                     "expected",
                                                     kind, fmt::join(kIdleKindNames, " ")));
  }
  if (pattern != 0) {
    const std::size_t count = tables_.motions.Patterns(*life);
    if (auto fits = CheckPattern(kind, pattern, 0, count); !fits) return fits;
  }
  idle_.Set(now, *life, static_cast<std::size_t>(pattern));
  return {};
}

vm::Result<void> FaceMotion::SetIdle(vm::Time now, std::string_view profile) {
  IdleProfile wanted{};
  if (profile == "OFF") {
    wanted[static_cast<std::size_t>(IdleKind::kAsymmetry)] = 1;
  } else {
    const auto found = tables_.motions.profiles.find(profile);
    if (found == tables_.motions.profiles.end()) {
      return vm::Fail(vm::Errc::kBadValue, fmt::format("'{}' is no way to live; {} or OFF expected",
                                                       profile, KeysOf(tables_.motions.profiles)));
    }
    wanted = found->second;
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto kind = static_cast<IdleKind>(i);
    if (wanted[i] == (idle_.On(kind) ? idle_.Pattern(kind) : 0)) continue;
    idle_.Set(now, kind, wanted[i]);
  }
  return {};
}

void FaceMotion::SetPerson(std::uint64_t person) {
  side_lags_ = SideLagsOf(Scramble(seed_ ^ person));
}

// ---- speech

void FaceMotion::Speak(vm::Time now, const vm::PhonemeList& phonemes, vm::Time start) {
  const std::uint64_t seed = Scramble(seed_ + static_cast<std::uint64_t>(++utterances_));
  speech_.Start(now, VisemeTrack(phonemes, tables_, settings_.lips), start, seed);
}

std::vector<std::string> FaceMotion::UnknownPhonemes(const vm::PhonemeList& phonemes) const {
  return MakeDemands(phonemes, tables_, settings_.lips).unknown;
}

void FaceMotion::SetShapes(bool bilingual, Visemes shapes) {
  Visemes& own = (bilingual ? tables_.set28 : tables_.set14).shapes;
  assert(shapes.size() == own.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    const float contact = own[i].pose.contact;
    own[i].pose = shapes[i].pose;
    own[i].pose.contact = contact;
    own[i].hold = shapes[i].hold;
  }
}

void FaceMotion::StopSpeaking(vm::Time now) { speech_.Stop(now); }

void FaceMotion::Sync(vm::Time now, double voice_ms) {
  speech_.Sync(now, voice_ms + settings_.sync_offset_ms, settings_.sync_rate);
}

void FaceMotion::Apply(vm::Time now, const MotionSettings& settings) {
  const double lead = settings.lead_ms - settings.offset_ms;
  if (lead != settings_.lead_ms - settings_.offset_ms) speech_.SetLead(now, lead);
  if (settings.mouth_scale != settings_.mouth_scale) {
    mouth_scale_.MoveTo(now, static_cast<float>(settings.mouth_scale), kScaleMove);
  }
  settings_ = settings;
}

}  // namespace fsm
