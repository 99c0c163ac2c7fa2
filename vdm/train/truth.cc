#include "vdm/train/truth.h"

#include "vdm/net/sound_classes.h"

namespace vdm {

static_assert(kMouthParameters == fsm::kMouthParameters);

TextDrivenMouth::TextDrivenMouth(const vm::PhonemeList& phonemes, const fsm::MotionTables& tables)
    : track_(phonemes, tables, fsm::LipStyle{}) {}

MouthTruth TextDrivenMouth::Sampled(double start_ms, double step_ms, std::size_t count) const {
  MouthTruth truth = ClosedMouth(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double ms = start_ms + step_ms * static_cast<double>(k);
    const fsm::MouthPose pose = track_.At(ms);
    const auto column = static_cast<Eigen::Index>(k);
    for (std::size_t i = 0; i < kMouthParameters; ++i) {
      truth.shape(static_cast<Eigen::Index>(i), column) = pose.mouth[i];
    }
    truth.shape(kMouthParameters, column) = pose.tongue;
    truth.closed[column] = pose.seal;
    truth.sound[k] = SoundClasses::Built().Of(track_.PhonemeAt(ms));
  }
  return truth;
}

MouthTruth ClosedMouth(std::size_t count) {
  const auto columns = static_cast<Eigen::Index>(count);
  return {Eigen::MatrixXf::Zero(kShapeNumbers, columns), Eigen::VectorXf::Ones(columns),
          std::vector<std::size_t>(count)};
}

}  // namespace vdm
