#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/face/weight_sets.h"
#include "sound/sound_file.h"
#include "vdm/mouth/mouth_tracker.h"

namespace gateway {

/// Sound in, weights of a mouth out: what a client hears of its own sound. Time is counted in
/// samples from where the sound began, so the same sound gives the same weights, however it comes.
/// Lifetime: network and set outlive it. Thread: none of its own; one instance, one thread.
class LiveFace {
 public:
  struct Settings {
    const WeightSet* set = nullptr;
    unsigned rate_hz = 16'000;  ///< 8000 to 48000
    unsigned fps = 50;          ///< 20, 25, 50 or 100
  };
  struct Moment {
    double at_s = 0;
    std::vector<float> weights;
    vdm::MouthFrame mouth{};  ///< what they were made of
  };
  LiveFace(const vdm::MouthNet& net, const Settings& settings);

  /// 16 bit little-endian mono; half a sample waits for its other half. Returns the moments this
  /// decides, in time.
  std::vector<Moment> Add(std::string_view pcm);
  std::vector<Moment> Add(const std::vector<std::int16_t>& samples);
  /// No more comes: the last moments, up to the end of the sound. What comes next begins anew.
  std::vector<Moment> End();
  /// What was said of later moments is void; what comes next begins anew.
  void Clear();
  /// How long the sound is that came since it began.
  double heard_s() const;
  /// So much later than a moment's sound the moment can be told.
  double ahead_s() const;
  const Settings& settings() const { return settings_; }

 private:
  std::vector<Moment> Track(std::span<const std::int16_t> samples_16k);

  const vdm::MouthNet& net_;
  const Settings settings_;
  std::unique_ptr<vdm::MouthTracker> tracker_;
  std::unique_ptr<sound::StreamResampler> resampler_;
  std::string half_;  // the first byte of a sample
  std::uint64_t heard_ = 0;
};

struct LiveRates {
  unsigned rate_hz = 0, fps = 0;
};
/// What a client asks for, in its words. kBadValue names what was found and expected.
vm::Result<LiveRates> ReadLive(std::string_view rate, std::string_view fps);

}  // namespace gateway
