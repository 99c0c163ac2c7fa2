#include "vdm/train/lesson.h"

#include "vdm/features/level_normaliser.h"
#include "vdm/train/distortion.h"
#include "vdm/train/truth.h"

namespace vdm {
namespace {

double HopMs(FeatureKind kind) {
  return 1000.0 * static_cast<double>(MakeFeatures(kind)->hop_samples()) / kSampleRateHz;
}

}  // namespace

Eigen::MatrixXf FeaturesOf(std::span<const std::int16_t> samples, FeatureKind kind, float warp) {
  const auto features = MakeFeatures(kind, warp);
  std::vector<float> vectors;
  features->Add(samples, vectors);
  const auto rows = static_cast<Eigen::Index>(features->size());
  return Eigen::Map<const Eigen::MatrixXf>(vectors.data(), rows,
                                           static_cast<Eigen::Index>(vectors.size()) / rows);
}

Lesson PlainLesson(const Take& take, FeatureKind kind, const fsm::MotionTables& tables) {
  Lesson lesson{.features = FeaturesOf(take.samples, kind)};
  lesson.truth = TextDrivenMouth(take.phonemes, tables)
                     .Sampled(0, HopMs(kind), static_cast<std::size_t>(lesson.features.cols()));
  return lesson;
}

Lesson DistortedLesson(const Take& take, FeatureKind kind, const fsm::MotionTables& tables,
                       Dice dice) {
  const HeardSpeech heard = Distorted(take.samples, dice);
  Lesson lesson{.features = FeaturesOf(heard.samples, kind, heard.warp)};
  lesson.truth = TextDrivenMouth(take.phonemes, tables)
                     .Sampled(-heard.start_ms * heard.speed, HopMs(kind) * heard.speed,
                              static_cast<std::size_t>(lesson.features.cols()));
  return lesson;
}

void Mask(Eigen::MatrixXf& features, FeatureKind kind, Dice& dice) {
  constexpr std::size_t kBands = LevelNormaliser::kBands, kWidest = 6, kLongest = 7;
  constexpr int kRanges = 2, kFramesPerMoment = 100;
  constexpr double kPhoneHidden = 0.1;
  const auto index = [](std::size_t n) { return static_cast<Eigen::Index>(n); };
  for (int range = 0; range < kRanges; ++range) {
    const std::size_t width = dice.Below(kWidest + 1), first = dice.Below(kBands - width + 1);
    features.middleRows(index(first), index(width)).setZero();
  }
  const auto frames = static_cast<std::size_t>(features.cols());
  for (std::size_t moment = 0; moment < frames / kFramesPerMoment; ++moment) {
    const std::size_t width = dice.Below(kLongest + 1), first = dice.Below(frames - width + 1);
    features.block(0, index(first), index(kBands), index(width)).setZero();
  }
  if (kind != FeatureKind::kPhones) return;
  for (std::size_t row = FeatureSize(FeatureKind::kMel); row < FeatureSize(kind); ++row) {
    if (dice.Chance(kPhoneHidden)) features.row(index(row)).setZero();
  }
}

Lesson SilentLesson(FeatureKind kind, Dice dice) {
  Lesson lesson{.features = FeaturesOf(NoSpeech(dice), kind)};
  lesson.truth = ClosedMouth(static_cast<std::size_t>(lesson.features.cols()));
  return lesson;
}

}  // namespace vdm
