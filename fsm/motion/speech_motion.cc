#include "fsm/motion/speech_motion.h"

#include <cmath>

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr vm::Time kTakeOver = 60ms;  // the mouth comes under speech
constexpr vm::Time kEmotionYields = 150ms;
constexpr vm::Time kClose = 110ms;      // after STOP; the promise is 120
constexpr vm::Time kClosedFor = 120ms;  // before emotion may part the lips again
constexpr vm::Time kRelease = 300ms;
constexpr vm::Time kHeadStops = 400ms;  // movement with the speech, after STOP

}  // namespace

double SpeechMotion::MouthPosition(const Layer& layer, vm::Time t) const {
  return layer.clock.PositionAt(t) + lead_ms_.At(t);
}

vm::Time SpeechMotion::EndOf(const Layer& layer) const {
  // The voice's end, or the mouth's if that is later because the mouth is told to lag.
  const double lead = lead_ms_.At(layer.clock.WhenAt(layer.track->length_ms()));
  return layer.clock.WhenAt(layer.track->length_ms() + std::max(0.0, -lead));
}

vm::Time SpeechMotion::GoneAt(const Layer& layer) const {
  return (layer.stopped ? *layer.stopped + kClosedFor : EndOf(layer)) +
         std::max(kRelease, FromMs(SpeechGestures::kFadeMs));
}

void SpeechMotion::Start(vm::Time now, VisemeTrack track, vm::Time start, std::uint64_t seed) {
  Stop(now);
  std::erase_if(layers_, [&](const Layer& layer) { return GoneAt(layer) <= now; });
  const vm::Time ahead = FromMs(lead_ms_.At(now) + kApproachMs);
  SpeechGestures gestures(track.demands(), seed);
  layers_.push_back({std::make_shared<const VisemeTrack>(std::move(track)), std::move(gestures),
                     SpeechClock(start), std::max(now, start - ahead), std::nullopt});
}

void SpeechMotion::Stop(vm::Time now) {
  if (!active()) return;
  if (now >= EndOf(layers_.back())) return;
  layers_.back().stopped = now;
}

void SpeechMotion::Sync(vm::Time now, double voice_ms, double max_rate) {
  if (active()) layers_.back().clock.Correct(now, voice_ms, max_rate);
}

void SpeechMotion::SetLead(vm::Time now, double lead_ms) {
  const double way = std::abs(lead_ms - lead_ms_.At(now));
  // At most a fifth faster or slower than time, so that the phonemes never run backwards.
  lead_ms_.MoveTo(now, static_cast<float>(lead_ms), active() ? FromMs(way * 10) : vm::Time(0));
}

SpeechMotion::Mouth SpeechMotion::At(vm::Time t) const {
  Mouth mouth;
  for (const Layer& layer : layers_) {
    const vm::Time release = layer.stopped ? *layer.stopped + kClosedFor : EndOf(layer);
    const double stays = 1 - SmoothStep(Progress(t, release, kRelease));
    const double share = SmoothStep(Progress(t, layer.begin, kTakeOver)) * stays;
    if (share <= 0) continue;
    MouthPose pose = layer.track->At(MouthPosition(layer, t));
    if (layer.stopped) {
      MouthPose closed;
      closed.seal = 1;
      closed.contact = 1;
      pose = Mix(pose, closed, SmoothStep(Progress(t, *layer.stopped, kClose)));
    }
    mouth.pose = Mix(mouth.pose, pose, share);
    mouth.share = 1 - (1 - mouth.share) * (1 - share);
    const double yields = SmoothStep(Progress(t, layer.begin, kEmotionYields)) * stays;
    mouth.over_emotion = 1 - (1 - mouth.over_emotion) * (1 - yields);
  }
  return mouth;
}

SpeechMotion::Gesture SpeechMotion::GestureAt(vm::Time t, double shortest_avert_ms) const {
  Gesture out;
  for (const Layer& layer : layers_) {
    if (t < layer.begin || t >= GoneAt(layer)) continue;
    const double position = MouthPosition(layer, t);
    const double stays =
        layer.stopped ? 1 - SmoothStep(Progress(t, *layer.stopped, kHeadStops)) : 1;
    const SpeechGestures::At head = layer.gestures.HeadAt(position);
    const auto avert = layer.gestures.AvertAt(position, shortest_avert_ms);
    out.head.nod += stays * head.nod;
    out.head.turn += stays * head.turn;
    out.head.tilt += stays * head.tilt;
    out.head.brow = std::max(out.head.brow, stays * head.brow);
    for (std::size_t i = 0; i < 2; ++i) out.avert[i] += stays * avert[i];
  }
  return out;
}

std::optional<SpeechMotion::Moments> SpeechMotion::LastMoments(double shortest_avert_ms) const {
  if (layers_.empty()) return std::nullopt;
  const Layer& layer = layers_.back();
  Moments moments{{}, {}, layer.stopped.value_or(EndOf(layer))};
  const auto [away, back] = layer.gestures.AvertTimes(shortest_avert_ms);
  if (back > away) {
    const double lead = lead_ms_.At(layer.begin);
    moments.away = layer.clock.WhenAt(away - lead);
    moments.back = layer.clock.WhenAt(back - lead);
  }
  return moments;
}

std::optional<vm::Time> SpeechMotion::End() const {
  if (!active()) return std::nullopt;
  return EndOf(layers_.back());
}

double SpeechMotion::VoicePositionAt(vm::Time t) const {
  if (layers_.empty()) return 0;
  const Layer& layer = layers_.back();
  const double position = layer.clock.PositionAt(std::min(t, layer.stopped.value_or(t)));
  return std::clamp(position, 0.0, layer.track->length_ms());
}

const std::string& SpeechMotion::PhonemeAt(vm::Time t) const {
  static const std::string kNone;
  if (!active()) return kNone;
  return layers_.back().track->PhonemeAt(MouthPosition(layers_.back(), t));
}

std::optional<vm::Time> SpeechMotion::NextActivity(vm::Time t) const {
  std::optional<vm::Time> next;
  for (const Layer& layer : layers_) {
    if (t >= GoneAt(layer)) continue;
    next = Earlier(next, std::max(t, layer.begin));
  }
  return next;
}

}  // namespace fsm
