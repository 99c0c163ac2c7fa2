#include "vdm/train/lesson.h"

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
  constexpr std::size_t kBands = 24, kWidest = 6, kLongest = 7;
  for (int ranges = 0; ranges < 2; ++ranges) {
    const std::size_t width = dice.Below(kWidest + 1), first = dice.Below(kBands - width + 1);
    features.middleRows(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(width))
        .setZero();
  }
  const Eigen::Index moments = features.cols() / 100;
  for (Eigen::Index k = 0; k < moments; ++k) {
    const auto width = static_cast<Eigen::Index>(dice.Below(kLongest + 1));
    const auto first = static_cast<Eigen::Index>(
        dice.Below(static_cast<std::size_t>(features.cols() - width + 1)));
    features.middleCols(first, width).topRows(kBands).setZero();
  }
  if (kind != FeatureKind::kPhones) return;
  const auto first_phone = static_cast<Eigen::Index>(FeatureSize(FeatureKind::kMel));
  for (Eigen::Index row = first_phone; row < features.rows(); ++row) {
    if (dice.Chance(0.1)) features.row(row).setZero();
  }
}

Lesson SilentLesson(FeatureKind kind, Dice dice) {
  Lesson lesson{.features = FeaturesOf(NoSpeech(dice), kind)};
  lesson.truth = ClosedMouth(static_cast<std::size_t>(lesson.features.cols()));
  return lesson;
}

}  // namespace vdm
