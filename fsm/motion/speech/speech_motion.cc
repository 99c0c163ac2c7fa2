#include "fsm/motion/speech/speech_motion.h"

#include <cmath>

#include "fsm/motion/base/layer_names.h"
#include "fsm/motion/base/random_streams.h"
#include "fsm/motion/inputs/motion_inputs.h"
#include "fsm/motion/speech/speech_timing.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr vm::Time kEmotionFade = 150ms;
constexpr vm::Time kClosedFor = 120ms;  // after STOP, until emotions may part the lips
constexpr vm::Time kHeadStops = 400ms;  // fading of gestures after STOP
constexpr double kMsPerLeadMs = 10;  // for a change of the lead, so that the mouth never goes back

}  // namespace

SpeechMotion::SpeechMotion(const MotionInputs& in)
    : tables_(in.tables),
      settings_(in.settings),
      mouth_scale_(in.mouth_scale),
      switches_(in.switches),
      seed_(in.seed) {}

double SpeechMotion::MouthPosition(const Utterance& utterance, vm::Time t) const {
  return utterance.clock.PositionAt(t) + lead_ms_.At(t);
}

vm::Time SpeechMotion::EndOf(const Utterance& utterance) const {
  // The end of the voice, or of the mouth if offset_ms makes that later.
  const double lead = lead_ms_.At(utterance.clock.WhenAt(utterance.track->length_ms()));
  return utterance.clock.WhenAt(utterance.track->length_ms() + std::max(0.0, -lead));
}

vm::Time SpeechMotion::FadedAt(const Utterance& utterance) const {
  return (utterance.stopped ? *utterance.stopped + kClosedFor : EndOf(utterance)) +
         std::max(kMouthFadeOut, kHeadReturns);
}

void SpeechMotion::Start(vm::Time now, const vm::PhonemeList& phonemes, vm::Time start,
                         std::string_view text) {
  Stop(now);
  std::erase_if(utterances_, [&](const Utterance& utterance) { return FadedAt(utterance) <= now; });
  auto track = std::make_shared<const VisemeTrack>(phonemes, tables_, settings_.lips);
  const std::uint64_t seed = Scramble(seed_ + static_cast<std::uint64_t>(++utterance_count_));
  SpeechGestures gestures(track->targets(), tables_.gestures, seed);
  auto looks = LooksOf(tables_.text_cues, text, track->targets(), tables_.gestures);
  const vm::Time ahead = FromMs(lead_ms_.At(now) + kTransitionMs);
  utterances_.push_back({std::move(track), std::move(gestures), std::move(looks),
                         SpeechClock(start), std::max(now, start - ahead), std::nullopt});
}

void SpeechMotion::Stop(vm::Time now) {
  if (!active()) return;
  if (now >= EndOf(utterances_.back())) return;
  utterances_.back().stopped = now;
}

void SpeechMotion::Sync(vm::Time now, double voice_ms) {
  if (!active()) return;
  utterances_.back().clock.Correct(now, voice_ms + settings_.sync_offset_ms, settings_.sync_rate);
}

void SpeechMotion::MoveLead(vm::Time now, double lead_ms) {
  const double change = std::abs(lead_ms - lead_ms_.At(now));
  lead_ms_.MoveTo(now, static_cast<float>(lead_ms),
                  active() ? FromMs(change * kMsPerLeadMs) : vm::Time(0));
}

SpeechMotion::Mouth SpeechMotion::MouthAt(vm::Time t) const {
  Mouth mouth;
  for (const Utterance& utterance : utterances_) {
    const vm::Time release = utterance.stopped ? *utterance.stopped + kClosedFor : EndOf(utterance);
    const double remaining = 1 - SmoothStep(Progress(t, release, kMouthFadeOut));
    const double share = SmoothStep(Progress(t, utterance.begin, kMouthFadeIn)) * remaining;
    if (share <= 0) continue;
    MouthPose pose = utterance.track->At(MouthPosition(utterance, t));
    if (utterance.stopped) {
      pose = Mix(pose, ClosedMouth(), SmoothStep(Progress(t, *utterance.stopped, kMouthCloses)));
    }
    mouth.BlendOver(pose, share);
    const double reduction = SmoothStep(Progress(t, utterance.begin, kEmotionFade)) * remaining;
    mouth.emotion_reduction = 1 - (1 - mouth.emotion_reduction) * (1 - reduction);
  }
  return mouth;
}

// ---- gestures

double SpeechMotion::GesturesOf(const Utterance& utterance, vm::Time t) const {
  if (t < utterance.begin || t >= FadedAt(utterance)) return 0;
  return utterance.stopped ? 1 - SmoothStep(Progress(t, *utterance.stopped, kHeadStops)) : 1;
}

void SpeechMotion::MoveHeadAndBrows(vm::Time t, MotionLayer& layer) const {
  AutoSpeech size{.nod = 0, .turn = 0, .tilt = 0, .brow = 0};
  for (const IdleRun& run : switches_[IdleKind::kSpeech].runs.At(t)) {
    const AutoSpeech& pattern = PatternAt(tables_.motions.auto_speeches, run.pattern);
    size.nod += run.weight * pattern.nod;
    size.turn += run.weight * pattern.turn;
    size.tilt += run.weight * pattern.tilt;
    size.brow += run.weight * pattern.brow;
  }
  double brow = 0;
  for (const Utterance& utterance : utterances_) {
    const double remaining = GesturesOf(utterance, t);
    if (remaining <= 0) continue;
    const SpeechGestures::HeadGesture head = utterance.gestures.HeadAt(MouthPosition(utterance, t));
    layer.head_rotation[kDown] += static_cast<float>(remaining * size.nod * head.nod);
    layer.head_rotation[kToRight] += static_cast<float>(remaining * size.turn * head.turn);
    layer.head_rotation[kTilted] += static_cast<float>(remaining * size.tilt * head.tilt);
    brow = std::max(brow, remaining * size.brow * head.brow);
  }
  for (const Side side : kSides) {
    layer.look.au[side][kInnerBrowRaiser] = static_cast<float>(kInnerBrowRaise * brow);
    layer.look.au[side][kOuterBrowRaiser] = static_cast<float>(kOuterBrowRaise * brow);
  }
}

void SpeechMotion::ShowLooks(vm::Time t, MotionLayer& layer) const {
  double size = 0;
  for (const IdleRun& run : switches_[IdleKind::kText].runs.At(t)) {
    size += PatternAt(tables_.motions.auto_texts, run.pattern).size * run.weight;
  }
  for (const Utterance& utterance : utterances_) {
    const double remaining = size * GesturesOf(utterance, t);
    if (remaining <= 0) continue;
    for (const TimedLook& timed : utterance.looks) {
      const auto weight =
          static_cast<float>(remaining * timed.At(MouthPosition(utterance, t), tables_.gestures));
      if (weight <= 0) continue;
      AddTo(layer.look, timed.shown->look, weight);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        layer.head_rotation[axis] += weight * timed.shown->head_rotation[axis];
      }
    }
  }
}

void SpeechMotion::AvertEyes(vm::Time t, MotionLayer& layer) const {
  for (const IdleRun& run : switches_[IdleKind::kAvert].runs.At(t)) {
    const AutoAvert& avert = PatternAt(tables_.motions.auto_averts, run.pattern);
    for (const Utterance& utterance : utterances_) {
      const double remaining = avert.angle * run.weight * GesturesOf(utterance, t);
      if (remaining == 0) continue;
      const auto away =
          utterance.gestures.AvertedGazeAt(MouthPosition(utterance, t), avert.shortest_ms);
      for (std::size_t i = 0; i < 2; ++i) {
        layer.look.gaze.left[i] += static_cast<float>(remaining * away[i]);
      }
    }
  }
  layer.look.gaze.right = layer.look.gaze.left;
}

double SpeechMotion::BlinkAt(vm::Time t) const {
  const std::size_t avert = switches_[IdleKind::kAvert].pattern;
  const bool at_end = switches_[IdleKind::kEndBlink].on();
  const bool at_shifts = switches_[IdleKind::kGazeBlink].on() && avert > 0;
  if ((!at_end && !at_shifts) || tables_.motions.blinks.empty() || utterances_.empty()) return 0;
  double shut = 0;
  const auto blink = [&](vm::Time start) {
    shut = std::max(shut, LidsAt(tables_.motions.blinks.front(), t - start));
  };
  const Utterance& last = utterances_.back();
  const MovementNumbers::EndBlink& end = tables_.gestures.end_blink;
  if (at_end && RandomAt(seed_, RandomStream::kEndBlink, utterance_count_) < end.threshold) {
    blink(last.stopped.value_or(EndOf(last)) +
          FromMs(end.delay_ms.At(RandomAt(seed_, RandomStream::kEndBlinkTime, utterance_count_))));
  }
  if (!at_shifts) return shut;
  const auto [away, back] =
      last.gestures.AversionTimes(PatternAt(tables_.motions.auto_averts, avert).shortest_ms);
  if (back <= away) return shut;
  const double lead = lead_ms_.At(last.begin);
  if (RandomAt(seed_, RandomStream::kAvertBlink, 2 * utterance_count_) < 0)
    blink(last.clock.WhenAt(away - lead));
  if (RandomAt(seed_, RandomStream::kAvertBlink, 2 * utterance_count_ + 1) < 0)
    blink(last.clock.WhenAt(back - lead));
  return shut;
}

// ---- as a source

void SpeechMotion::Contribute(vm::Time t, MotionLayers& layers) const {
  const Mouth mouth = MouthAt(t);
  layers.AddSignal(SignalName::kSpeaking, mouth.emotion_reduction);
  mouth.Contribute(mouth_scale_.At(t), LayerName::kSpeech, layers);
  MotionLayer& gestures = layers.Layer(LayerName::kGestures);
  MoveHeadAndBrows(t, gestures);
  AvertEyes(t, gestures);
  ShowLooks(t, layers.Layer(LayerName::kText));
  gestures.blink.left = gestures.blink.right = static_cast<float>(BlinkAt(t));
}

// ---- where it is

std::optional<vm::Time> SpeechMotion::End() const {
  if (!active()) return std::nullopt;
  return EndOf(utterances_.back());
}

double SpeechMotion::VoicePositionAt(vm::Time t) const {
  if (utterances_.empty()) return 0;
  const Utterance& utterance = utterances_.back();
  const double position = utterance.clock.PositionAt(std::min(t, utterance.stopped.value_or(t)));
  return std::clamp(position, 0.0, utterance.track->length_ms());
}

const std::string& SpeechMotion::PhonemeAt(vm::Time t) const {
  static const std::string kNone;
  if (!active()) return kNone;
  return utterances_.back().track->PhonemeAt(MouthPosition(utterances_.back(), t));
}

std::optional<vm::Time> SpeechMotion::NextMotion(vm::Time t) const {
  std::optional<vm::Time> next = mouth_scale_.NextMotion(t);
  for (const Utterance& utterance : utterances_) {
    if (t >= FadedAt(utterance)) continue;
    next = Earlier(next, std::max(t, utterance.begin));
  }
  return next;
}

}  // namespace fsm
