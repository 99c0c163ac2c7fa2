#include "face_track/fit/dose_prior.h"

namespace facetrack {
namespace {

constexpr float kVariesAnyway = 0.005F;  // mm by which any variation may be there without a unit

}  // namespace

Eigen::VectorXf SureOfNone(const SeenFace& face, const std::vector<float>& doses) {
  Eigen::VectorXf variance = Eigen::VectorXf::Constant(
      static_cast<Eigen::Index>(face.variations.size()), kVariesAnyway * kVariesAnyway);
  for (std::size_t c = 0; c < doses.size(); ++c) {
    if (doses[c] == 0) continue;
    const Channel& channel = face.channels[c];
    const float part = doses[c] / channel.usual();
    const Eigen::Map<const Eigen::VectorXf> varies(channel.varies.data(), variance.size());
    variance += part * part * varies.cwiseAbs2();
  }
  return variance.cwiseInverse();
}

}  // namespace facetrack
