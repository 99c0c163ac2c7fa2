#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "vdm/net/mouth_frame.h"
#include "vdm/net/net_stream.h"

namespace vdm {

/// Sound in, mouths out, as soon as a network can say them. 16 kHz mono, in pieces of any size.
/// Lifetime: the network outlives it. Thread: none of its own; one instance, one thread.
class MouthTracker {
 public:
  /// `warp`: see MakeFeatures.
  explicit MouthTracker(const MouthNet& net, float warp = 1);

  struct Moment {
    std::uint64_t sample = 0;  ///< counted from the first one added
    MouthFrame frame;
  };
  /// What the sound so far decides, in time, one moment each hop of the features.
  std::vector<Moment> Add(std::span<const std::int16_t> samples);
  /// How many samples after a moment's own must have come before it is said.
  std::size_t ahead_samples() const;
  std::size_t hop_samples() const { return features_->hop_samples(); }

 private:
  const MouthNet& net_;
  std::unique_ptr<SoundFeatures> features_;
  NetStream stream_;
  MouthMotion motion_;
  std::uint64_t moments_ = 0;
  std::vector<float> vectors_;
};

}  // namespace vdm
