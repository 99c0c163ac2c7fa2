#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vdm/prosody/discriminant.h"
#include "vdm/prosody/prosody_stream.h"

namespace vdm {

/// Measures phrases: what they are beside the speaker's usual. A phrase is measured when it has
/// ended, a long one also each kAgain meanwhile. Phrases with less than kLeastVoice of voice, and
/// those heard before the speaker's usual is known a little, are not measured.
/// Thread: none of its own; one instance, one thread.
class PhraseMeter {
 public:
  static constexpr int kEnds = 25;        ///< hops of 10 ms of pause
  static constexpr int kAgain = 200;      ///< hops of speech
  static constexpr int kLeastVoice = 50;  ///< hops
  static constexpr double kKnown = 300;   ///< hops of voice from which on a usual counts as known

  /// pitch: the mean, semitones above the usual; range: the natural logarithm of the deviation of
  /// the pitch beside the usual one; power and tilt: the means, dB above the usual; rate: the
  /// natural logarithm of syllables a second beside the usual.
  static const std::vector<std::string>& FeatureNames();

  /// REQUIRES: the stream has taken the frame just now. What the phrase measures, if it is time.
  std::optional<Eigen::VectorXd> Add(const ProsodyFrame& frame, const ProsodyStream& stream);

 private:
  std::optional<Eigen::VectorXd> Measured(const SpeakerUsual& usual) const;

  int hops_ = 0, voiced_ = 0, syllables_ = 0;  // of the phrase, from its first speech on
  int speech_hops_ = 0;                        // until its last speech
  int again_ = kAgain;
  double pitch_ = 0, pitch_squares_ = 0, power_ = 0, tilt_ = 0;
};

/// What a voice says of how its speaker feels, by discriminant functions over the measures of a
/// phrase; their classes are what it may say. The likelihoods of one phrase and the next are
/// averaged, so that one odd phrase says little. Lifetime: the functions outlive it.
class EmotionReader {
 public:
  /// Hops of no speech after which nothing is said any more.
  static constexpr int kForgets = 400;

  explicit EmotionReader(const Discriminant& functions)
      : functions_(functions), likely_(functions.classes.size()) {}
  /// REQUIRES: the stream has taken the frame just now. True if what it says is another.
  bool Add(const ProsodyFrame& frame, const ProsodyStream& stream);
  /// Beside the classes of the functions; empty: nothing can be said.
  const std::vector<double>& likelihoods() const { return said_; }

 private:
  const Discriminant& functions_;
  PhraseMeter meter_;
  std::vector<double> likely_;
  bool any_ = false;
  std::vector<double> said_;
};

/// The discriminant functions the program carries (docs/vdm.md says what they learned from).
const Discriminant& ShippedEmotions();

}  // namespace vdm
