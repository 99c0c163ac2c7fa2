#pragma once

namespace vdm {

/// Counts the nuclei of syllables: peaks of the level with a dip of kDip dB before and after them,
/// at which there is a voice (N. de Jong, T. Wempe, Praat script to detect syllable nuclei and
/// measure speech rate automatically, Behavior Research Methods 41, 2009). A nucleus is counted
/// when the dip after it is there. A plain value.
class SyllableCounter {
 public:
  static constexpr float kDip = 2;

  /// The level of the next 10 ms in dB, smoothed here over three. True if a nucleus has ended.
  bool Add(float level_db, bool voiced);

 private:
  float before_ = 0, before_that_ = 0;
  bool rising_ = false;
  bool voiced_at_top_ = false;
  float top_ = 0, bottom_ = 0;
};

}  // namespace vdm
