#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "srm/engine/feature_mean.h"
#include "srm/engine/pocketsphinx_handle.h"

/// Private to srm/engine.
namespace srm {

/// A part of a result in frames of 10 ms, with the score of its sound.
struct Segment {
  int first = 0, last = 0;
  double score = 0;
  int frames() const { return last - first + 1; }
};

Segment ReadSegment(ps_seg_t* seg);
/// A pause or a noise: what the engine puts between words.
bool IsFiller(const std::string& word);

/// The phonemes that fit best, whatever is said: what a grammar's fit is measured against. Its
/// scores are told by frame.
class FreePhonemes {
 public:
  /// REQUIRES: a decoder whose search is one of phonemes.
  explicit FreePhonemes(DecoderPtr decoder);
  void Begin();
  void Feed(const std::vector<std::int16_t>& samples);
  /// False if there is no answer.
  bool End();
  /// The whole utterance once more, with the mean of its own.
  bool Again(const std::vector<std::int16_t>& samples);
  std::int32_t total() const { return total_; }
  /// The score of some frames, the last one included.
  double Score(int first, int last) const;
  /// Whether a frame is taken for a pause or a noise.
  bool Silent(int frame) const;

 private:
  bool Read();

  const DecoderPtr decoder_;
  FeatureMean mean_;
  std::int32_t total_ = 0;
  std::vector<double> by_frame_;
  std::vector<bool> silent_;  // as long
};

}  // namespace srm
