#include "vdm/prosody/emotion_reader.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdm {
namespace {
constexpr double kSemitones = 12 / std::numbers::ln2;
constexpr double kNewCounts = 0.6;  // of the likelihoods, beside those before
}  // namespace

const std::vector<std::string>& PhraseMeter::FeatureNames() {
  static const std::vector<std::string> names = {"pitch", "range", "power", "tilt", "rate"};
  return names;
}

std::optional<Eigen::VectorXd> PhraseMeter::Add(const ProsodyFrame& frame,
                                                const ProsodyStream& stream) {
  const PhraseTracker& phrases = stream.phrases();
  std::optional<Eigen::VectorXd> measured;
  if (phrases.pause() >= kEnds) {
    if (phrases.pause() == kEnds) measured = Measured(stream.usual());
    *this = PhraseMeter();
    return measured;
  }
  ++hops_;
  syllables_ += stream.syllable_ended() ? 1 : 0;
  if (!phrases.speech()) return std::nullopt;
  speech_hops_ = hops_;
  if (frame.hz > 0) {
    ++voiced_;
    const double pitch = std::log(static_cast<double>(frame.hz));
    pitch_ += pitch;
    pitch_squares_ += pitch * pitch;
    power_ += static_cast<double>(frame.power_db);
    tilt_ += static_cast<double>(frame.tilt_db);
  }
  if (speech_hops_ < again_) return std::nullopt;
  again_ += kAgain;
  return Measured(stream.usual());
}

std::optional<Eigen::VectorXd> PhraseMeter::Measured(const SpeakerUsual& usual) const {
  if (voiced_ < kLeastVoice || usual.log_hz.weight() < kKnown) return std::nullopt;
  const double mean = pitch_ / voiced_;
  const double deviation = std::sqrt(std::max(pitch_squares_ / voiced_ - mean * mean, 1e-6));
  const double rate = std::max(syllables_, 1) * 100.0 / speech_hops_;
  Eigen::VectorXd features(5);
  features << kSemitones * (mean - usual.log_hz.mean()),
      std::log(deviation / usual.log_hz.deviation()), power_ / voiced_ - usual.power_db.mean(),
      tilt_ / voiced_ - usual.tilt_db.mean(), std::log(rate / usual.rate.mean());
  return features;
}

bool EmotionReader::Add(const ProsodyFrame& frame, const ProsodyStream& stream) {
  const auto measured = meter_.Add(frame, stream);
  if (stream.phrases().pause() == kForgets) {
    any_ = false;
    if (said_.empty()) return false;
    said_.clear();
    return true;
  }
  if (!measured) return false;
  const std::vector<double> now = functions_.Likelihoods(*measured);
  for (std::size_t k = 0; k < now.size(); ++k) {
    likely_[k] = any_ ? likely_[k] + kNewCounts * (now[k] - likely_[k]) : now[k];
  }
  any_ = true;
  said_ = likely_;
  return true;
}

}  // namespace vdm
