#include "fsm/motion/speech_motion.h"

#include <cmath>

#include "fsm/motion/random_streams.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr vm::Time kTakeOver = 60ms;  // speech takes control of the mouth
constexpr vm::Time kEmotionYields = 150ms;
constexpr vm::Time kClose = 110ms;      // closing after STOP; docs promise 120 ms
constexpr vm::Time kClosedFor = 120ms;  // after STOP, until emotions may part the lips
constexpr vm::Time kHeadStops = 400ms;  // fading of gestures after STOP

}  // namespace

double SpeechMotion::MouthPosition(const Utterance& one, vm::Time t) const {
  return one.clock.PositionAt(t) + lead_ms_.At(t);
}

vm::Time SpeechMotion::EndOf(const Utterance& one) const {
  // The end of the voice, or of the mouth if offset_ms makes that later.
  const double lead = lead_ms_.At(one.clock.WhenAt(one.track->length_ms()));
  return one.clock.WhenAt(one.track->length_ms() + std::max(0.0, -lead));
}

vm::Time SpeechMotion::GoneAt(const Utterance& one) const {
  return (one.stopped ? *one.stopped + kClosedFor : EndOf(one)) +
         std::max(kRelease, FromMs(SpeechGestures::kFadeMs));
}

void SpeechMotion::Start(vm::Time now, const vm::PhonemeList& phonemes, vm::Time start,
                         std::string_view text) {
  Stop(now);
  std::erase_if(said_, [&](const Utterance& one) { return GoneAt(one) <= now; });
  auto track = std::make_shared<const VisemeTrack>(phonemes, tables_, settings_.lips);
  const std::uint64_t seed = Scramble(seed_ + static_cast<std::uint64_t>(++utterances_));
  SpeechGestures gestures(track->visemes(), tables_.gestures, seed);
  auto looks = LooksOf(tables_.text_cues, text, track->visemes());
  const vm::Time ahead = FromMs(lead_ms_.At(now) + kApproachMs);
  said_.push_back({std::move(track), std::move(gestures), std::move(looks), SpeechClock(start),
                   std::max(now, start - ahead), std::nullopt});
}

void SpeechMotion::Stop(vm::Time now) {
  if (!active()) return;
  if (now >= EndOf(said_.back())) return;
  said_.back().stopped = now;
}

void SpeechMotion::Sync(vm::Time now, double voice_ms) {
  if (!active()) return;
  said_.back().clock.Correct(now, voice_ms + settings_.sync_offset_ms, settings_.sync_rate);
}

void SpeechMotion::Adjust(vm::Time now, const MotionSettings& next) {
  const double lead_ms = next.lead_ms - next.offset_ms;
  if (lead_ms != settings_.lead_ms - settings_.offset_ms) {
    const double way = std::abs(lead_ms - lead_ms_.At(now));
    // Limited to a fifth faster or slower than real time, so that the position never decreases.
    lead_ms_.MoveTo(now, static_cast<float>(lead_ms), active() ? FromMs(way * 10) : vm::Time(0));
  }
  if (next.mouth_scale != settings_.mouth_scale) {
    mouth_scale_.MoveTo(now, static_cast<float>(next.mouth_scale), kMouthScaleMove);
  }
}

SpeechMotion::Mouth SpeechMotion::MouthAt(vm::Time t) const {
  Mouth mouth;
  for (const Utterance& one : said_) {
    const vm::Time release = one.stopped ? *one.stopped + kClosedFor : EndOf(one);
    const double stays = 1 - Eased(Progress(t, release, kRelease));
    const double share = Eased(Progress(t, one.begin, kTakeOver)) * stays;
    if (share <= 0) continue;
    MouthPose pose = one.track->At(MouthPosition(one, t));
    if (one.stopped) {
      pose = Mix(pose, ClosedMouth(), Eased(Progress(t, *one.stopped, kClose)));
    }
    mouth.Cover(pose, share);
    const double yields = Eased(Progress(t, one.begin, kEmotionYields)) * stays;
    mouth.over_emotion = 1 - (1 - mouth.over_emotion) * (1 - yields);
  }
  return mouth;
}

// ---- gestures

const AutoAvert* SpeechMotion::Avert() const {
  const std::size_t pattern = idle_.Pattern(IdleKind::kAvert);
  return pattern == 0 ? nullptr : &PatternAt(tables_.motions.auto_averts, pattern);
}

double SpeechMotion::GesturesOf(const Utterance& one, vm::Time t) const {
  if (t < one.begin || t >= GoneAt(one)) return 0;
  return one.stopped ? 1 - Eased(Progress(t, *one.stopped, kHeadStops)) : 1;
}

void SpeechMotion::MoveHeadAndBrows(vm::Time t, MotionLayer& layer) const {
  const std::size_t pattern = idle_.Pattern(IdleKind::kSpeech);
  if (pattern == 0) return;
  const AutoSpeech& size = PatternAt(tables_.motions.auto_speeches, pattern);
  const double weight = idle_.Weight(IdleKind::kSpeech, t);
  double brow = 0;
  for (const Utterance& one : said_) {
    const double stays = weight * GesturesOf(one, t);
    if (stays <= 0) continue;
    const SpeechGestures::At head = one.gestures.HeadAt(MouthPosition(one, t));
    layer.head[kDown] += static_cast<float>(stays * size.nod * head.nod);
    layer.head[kToRight] += static_cast<float>(stays * size.turn * head.turn);
    layer.head[kTilted] += static_cast<float>(stays * size.tilt * head.tilt);
    brow = std::max(brow, stays * size.brow * head.brow);
  }
  for (const Side side : kSides) {
    layer.units.au[side][kInnerBrowRaiser] = static_cast<float>(kInnerBrow * brow);
    layer.units.au[side][kOuterBrowRaiser] = static_cast<float>(kOuterBrow * brow);
  }
}

void SpeechMotion::ShowLooks(vm::Time t, MotionLayer& layer) const {
  const std::size_t pattern = idle_.Pattern(IdleKind::kText);
  if (pattern == 0) return;
  const double size =
      PatternAt(tables_.motions.auto_texts, pattern).size * idle_.Weight(IdleKind::kText, t);
  for (const Utterance& one : said_) {
    const double stays = size * GesturesOf(one, t);
    if (stays <= 0) continue;
    for (const TimedLook& timed : one.looks) {
      const auto weight = static_cast<float>(stays * timed.At(MouthPosition(one, t)));
      if (weight <= 0) continue;
      AddTo(layer.units, timed.look->units, weight);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        layer.head[axis] += weight * timed.look->head[axis];
      }
    }
  }
}

void SpeechMotion::AvertEyes(vm::Time t, MotionLayer& layer) const {
  const AutoAvert* avert = Avert();
  if (avert == nullptr) return;
  const double angle = avert->angle * idle_.Weight(IdleKind::kAvert, t);
  for (const Utterance& one : said_) {
    const double stays = angle * GesturesOf(one, t);
    if (stays == 0) continue;
    const auto away = one.gestures.AvertAt(MouthPosition(one, t), avert->shortest_ms);
    for (std::size_t i = 0; i < 2; ++i) {
      layer.units.gaze.left[i] += static_cast<float>(stays * away[i]);
    }
  }
  layer.units.gaze.right = layer.units.gaze.left;
}

double SpeechMotion::LidsShutAt(vm::Time t) const {
  const bool at_end = idle_.On(IdleKind::kEndBlink);
  const bool at_shifts = idle_.On(IdleKind::kGazeBlink) && idle_.On(IdleKind::kAvert);
  if ((!at_end && !at_shifts) || tables_.motions.blinks.empty() || said_.empty()) return 0;
  double shut = 0;
  const auto blink = [&](vm::Time start) {
    shut = std::max(shut, LidsAt(tables_.motions.blinks.front(), t - start));
  };
  const Utterance& last = said_.back();
  // Most utterances end with a blink, just before or after the last sound.
  if (at_end && RandomAt(seed_, RandomStream::kEndBlink, utterances_) < 0.6) {
    blink(last.stopped.value_or(EndOf(last)) +
          FromMs(20 + 90 * RandomAt(seed_, RandomStream::kEndBlinkTime, utterances_)));
  }
  if (!at_shifts) return shut;
  const auto [away, back] = last.gestures.AvertTimes(Avert()->shortest_ms);
  if (back <= away) return shut;
  const double lead = lead_ms_.At(last.begin);
  if (RandomAt(seed_, RandomStream::kAvertBlink, 2 * utterances_) < 0)
    blink(last.clock.WhenAt(away - lead));
  if (RandomAt(seed_, RandomStream::kAvertBlink, 2 * utterances_ + 1) < 0)
    blink(last.clock.WhenAt(back - lead));
  return shut;
}

// ---- as a source

void SpeechMotion::Contribute(vm::Time t, MotionLayers& layers) const {
  const Mouth mouth = MouthAt(t);
  layers.AddSignal("speaking", mouth.over_emotion);
  mouth.Contribute(mouth_scale_.At(t), "speech", layers);
  MotionLayer& gestures = layers.Layer("gestures");
  MoveHeadAndBrows(t, gestures);
  AvertEyes(t, gestures);
  ShowLooks(t, layers.Layer("text"));
  gestures.lids_shut = static_cast<float>(LidsShutAt(t));
}

// ---- where it is

std::optional<vm::Time> SpeechMotion::End() const {
  if (!active()) return std::nullopt;
  return EndOf(said_.back());
}

double SpeechMotion::VoicePositionAt(vm::Time t) const {
  if (said_.empty()) return 0;
  const Utterance& one = said_.back();
  const double position = one.clock.PositionAt(std::min(t, one.stopped.value_or(t)));
  return std::clamp(position, 0.0, one.track->length_ms());
}

const std::string& SpeechMotion::PhonemeAt(vm::Time t) const {
  static const std::string kNone;
  if (!active()) return kNone;
  return said_.back().track->PhonemeAt(MouthPosition(said_.back(), t));
}

std::optional<vm::Time> SpeechMotion::NextActivity(vm::Time t) const {
  std::optional<vm::Time> next = mouth_scale_.NextActivity(t);
  for (const Utterance& one : said_) {
    if (t >= GoneAt(one)) continue;
    next = Earlier(next, std::max(t, one.begin));
  }
  return next;
}

}  // namespace fsm
