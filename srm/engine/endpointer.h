#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include "srm/engine/decoder.h"

namespace srm {

/// Finds where speech begins and ends by its energy above the noise, in frames of 10 ms. What is
/// heard shortly before the beginning belongs to the utterance.
/// Thread: none of its own. Pure: time is counted in samples.
class Endpointer {
 public:
  struct Settings {
    Millis silence{500};     ///< after so much of it an utterance is over
    Millis complete{0};      ///< after so much already if Events::complete says so; 0: never
    Millis onset{60};        ///< speech must last as long to begin one
    Millis lead{300};        ///< sound before the beginning that is handed over with it
    Millis longest{20'000};  ///< an utterance is ended after that
    double above_noise_db = 9;
    double floor_db = 36;  ///< of the amplitude, relative to 1; quieter than this is never speech
  };
  struct Events {
    std::function<void()> begin;
    /// Sound of the utterance, in order; not empty.
    std::function<void(std::span<const std::int16_t>)> sound;
    std::function<void()> end;
    /// Whether what was said is whole: asked in silence, from Settings::complete on each
    /// kAskEach. May be empty.
    std::function<bool()> complete{};
  };
  static constexpr Millis kAskEach{50};

  Endpointer(Settings settings, Events events);
  void Feed(std::span<const std::int16_t> samples);
  /// Ends an utterance that is going on, as at the end of a file.
  void Finish();
  /// Forgets what is going on, without an event.
  void Reset();
  Settings& settings() { return settings_; }
  bool in_speech() const { return in_speech_; }
  double noise_db() const { return noise_db_; }

 private:
  void Frame(std::span<const std::int16_t> frame);
  bool IsSpeech(double level_db);
  bool IsComplete() const;

  Settings settings_;
  const Events events_;
  std::vector<std::int16_t> partial_;  // less than a frame
  std::deque<std::int16_t> lead_;
  double noise_db_ = 0;
  int noise_frames_ = 0;
  bool in_speech_ = false;
  Millis speech_{0};   // of it, without a break, before the beginning
  Millis silence_{0};  // since the last speech
  Millis length_{0};   // of the utterance
};

}  // namespace srm
