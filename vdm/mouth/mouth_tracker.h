#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "vdm/net/mouth_frame.h"
#include "vdm/net/net_stream.h"

namespace vdm {

/// Sound in, mouths out, as soon as a network can say them, or two networks that hear the same by
/// other features: what they say is mixed. 16 kHz mono, in pieces of any size. Lifetime: the
/// networks outlive it. Thread: none of its own; one instance, one thread.
class MouthTracker {
 public:
  /// `warp`: see MakeFeatures. `second`: of the same sounds and hop, or none.
  explicit MouthTracker(const MouthNet& net, float warp = 1, const MouthNet* second = nullptr);

  struct Moment {
    std::uint64_t sample = 0;  ///< counted from the first one added
    MouthFrame frame;
  };
  /// What the sound so far decides, in time, one moment each hop of the features.
  std::vector<Moment> Add(std::span<const std::int16_t> samples);
  /// How many samples after a moment's own must have come before it is said.
  std::size_t ahead_samples() const;
  std::size_t hop_samples() const { return first_.hop_samples(); }

 private:
  /// A network and what it has said that is not used yet.
  class Listener {
   public:
    Listener(const MouthNet& net, float warp);
    void Add(std::span<const std::int16_t> samples);
    std::size_t ahead_samples() const;
    std::size_t hop_samples() const { return features_->hop_samples(); }
    const MouthNet& net() const { return net_; }
    std::deque<Eigen::VectorXf> said{};

   private:
    const MouthNet& net_;
    std::unique_ptr<SoundFeatures> features_;
    NetStream stream_;
    std::vector<float> vectors_{};
  };
  void Mix(Eigen::VectorXf& outputs, const Eigen::VectorXf& others) const;

  Listener first_;
  std::optional<Listener> second_;
  std::optional<Eigen::Index> closure_sound_{};  // the row of p, b and m
  MouthMotion motion_;
  std::uint64_t moments_ = 0;
};

}  // namespace vdm
