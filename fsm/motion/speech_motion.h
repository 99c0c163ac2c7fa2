#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fsm/motion/speech_clock.h"
#include "fsm/motion/speech_gestures.h"
#include "fsm/motion/track.h"
#include "fsm/motion/viseme_track.h"

namespace fsm {

/// Utterances on the mouth: begun, followed, corrected, stopped. An utterance that was stopped
/// fades under the next one. Commands come in order of time; queries are for now or later.
class SpeechMotion {
 public:
  /// The voice starts at `start`; the mouth begins up to 92 ms before that, and is ahead by the
  /// lead. `seed` is of what the head does with it.
  void Start(vm::Time now, VisemeTrack track, vm::Time start, std::uint64_t seed);
  /// The lips are closed 110 ms later.
  void Stop(vm::Time now);
  /// The voice is at `voice_ms` now. Ignored when nothing is spoken.
  void Sync(vm::Time now, double voice_ms, double max_rate);
  /// How far the mouth runs ahead of the voice (lead - offset, ms); eased while speaking.
  void SetLead(vm::Time now, double lead_ms);

  /// How much of the mouth speech owns, 0..1, and what it asks (full articulation).
  struct Mouth {
    double share = 0;         ///< of the mouth parameters
    double over_emotion = 0;  ///< how far emotion gives way; slower than `share` to be soft
    MouthPose pose;
  };
  Mouth At(vm::Time t) const;

  /// What head, brows and eyes do with the utterance, see SpeechGestures. `head` in parts of the
  /// greatest angles; `avert` in parts of the angle of aversion, down and right.
  struct Gesture {
    SpeechGestures::At head;
    std::array<double, 2> avert{};
  };
  Gesture GestureAt(vm::Time t, double shortest_avert_ms) const;
  /// When the eyes jump away and back in the last utterance, and when it ends or ended; none if
  /// there was none.
  struct Moments {
    std::optional<vm::Time> away, back;
    vm::Time end;
  };
  std::optional<Moments> LastMoments(double shortest_avert_ms) const;

  bool active() const { return !layers_.empty() && !layers_.back().stopped; }
  /// When the utterance in hand will be over, for voice and mouth; none if there is none.
  std::optional<vm::Time> End() const;
  double VoicePositionAt(vm::Time t) const;        ///< 0 if nothing is spoken
  const std::string& PhonemeAt(vm::Time t) const;  ///< on the mouth; "" = none
  std::optional<vm::Time> NextActivity(vm::Time t) const;

 private:
  struct Layer {
    std::shared_ptr<const VisemeTrack> track;
    SpeechGestures gestures;
    SpeechClock clock;
    vm::Time begin;
    std::optional<vm::Time> stopped;
  };
  vm::Time EndOf(const Layer& layer) const;
  vm::Time GoneAt(const Layer& layer) const;
  double MouthPosition(const Layer& layer, vm::Time t) const;

  std::vector<Layer> layers_;
  Track<float> lead_ms_{40.0f};
};

}  // namespace fsm
