#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "vdm/mouth/mouth_tracker.h"
#include "vdm/prosody/emotion_reader.h"
#include "vdm/prosody/head_mover.h"
#include "vdm/prosody/prosody_stream.h"

namespace vdm {

/// What a voice does beside its words, moment by moment with the mouth: the head moves with it, and
/// it may say how the speaker feels. Lifetime: networks and functions outlive it. Thread: one.
class VoiceManner {
 public:
  /// By how much the head is late beside a text-driven one (measured; bench/head_bench.cc).
  static constexpr std::size_t kHeadLate = 960;  ///< samples: 60 ms

  struct Parts {
    const HeadNet* head = nullptr;           ///< nullptr: no head
    const Discriminant* emotions = nullptr;  ///< nullptr: no emotion
    SpeakerUsual usual{};                    ///< to begin with
    std::uint64_t seed = 1;                  ///< of the poses that phrases have by chance
  };
  /// `mouth_ahead`, `mouth_hop`: of the mouth's tracker, in samples.
  VoiceManner(const Parts& parts, std::size_t mouth_ahead, std::size_t mouth_hop);

  /// The same sound as the mouth gets, before its moments.
  void Add(std::span<const std::int16_t> samples) { stream_.Add(samples); }

  struct Settings {
    float head_size = 1;
    std::optional<float> emotion{};  ///< for the head, 0 .. 1; none: as it is heard
    /// How many samples moments may wait, so that the head, which is late, is in time with them.
    std::size_t wait = 0;
  };
  using Tell = std::function<void(const MouthTracker::Moment&, const std::optional<HeadPose>&)>;
  /// The mouth of the next moment. `tell` is called for each moment that is due with it.
  void Take(MouthTracker::Moment moment, const Settings& settings, const Tell& tell);
  /// No more will come: tells what still waits.
  void Finish(const Tell& tell);

  /// What is said of the emotion has changed since this was asked last.
  bool TakeEmotionChanged() { return std::exchange(emotion_changed_, false); }
  /// Beside the classes of the functions; empty: nothing can be said.
  const std::vector<double>& emotions() const;
  const ProsodyStream& stream() const { return stream_; }
  const ProsodyFrame& prosody() const { return last_; }

 private:
  float Aroused() const;

  const Parts parts_;
  const std::size_t mouth_hop_;
  ProsodyStream stream_;
  std::unique_ptr<HeadMover> mover_;
  std::unique_ptr<EmotionReader> reader_;
  std::optional<HeadPose> head_;
  ProsodyFrame last_{};
  bool emotion_changed_ = false;
  std::deque<MouthTracker::Moment> waiting_;
};

/// The class whose likelihood makes a head lively.
inline constexpr const char* kAroused = "aroused";

}  // namespace vdm
