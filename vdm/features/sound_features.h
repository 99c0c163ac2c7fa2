#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vdm {

inline constexpr std::size_t kSampleRateHz = 16000;

/// What of the sound a network looks at.
enum class FeatureKind {
  kMel,      ///< 24 mel bands and two levels, each 10 ms; see MelFeatures
  kPhones,   ///< kMel and how likely the phones of English are; see PhoneFeatures
  kCepstra,  ///< 20 LPC cepstra, each 32 ms, as in the papers; see CepstraFeatures
  kWords,    ///< the phones that words of English would have, each 10 ms; see WordFeatures
};
std::string_view FeatureName(FeatureKind kind);  ///< "mel", "phones", "cepstra", "words"
std::size_t FeatureSize(FeatureKind kind);       ///< numbers in a vector

/// One vector of numbers for each hop of sound, 16 kHz mono. Sound may come in pieces of any size;
/// the vectors are the same. Thread: none of its own; one instance, one thread.
class SoundFeatures {
 public:
  virtual ~SoundFeatures() = default;
  virtual std::size_t size() const = 0;         ///< numbers in a vector
  virtual std::size_t hop_samples() const = 0;  ///< from one vector to the next
  /// Samples after the instant a vector stands for which it depends on.
  virtual std::size_t ahead_samples() const = 0;
  /// Appends the vectors that became complete; vector k stands for sample k * hop_samples().
  virtual void Add(std::span<const std::int16_t> samples, std::vector<float>& vectors) = 0;
};

/// `warp`, of kMel and kPhones: above 1 the spectrum is read at higher frequencies, as if the vocal
/// tract were longer than it is; 1 for sound as it is, 0.5 .. 1.5. Throws std::runtime_error for
/// kPhones and kWords if CanMakeFeatures says what is missing.
vm::Result<void> CanMakeFeatures(FeatureKind kind);
std::unique_ptr<SoundFeatures> MakeFeatures(FeatureKind kind, float warp = 1);

}  // namespace vdm
