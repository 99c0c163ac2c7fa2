#include "vdm/net/mouth_frame.h"

#include <algorithm>
#include <cmath>

namespace vdm {
namespace {

// Where the lips begin to close and where they are sealed, by the likelihood of a closure.
constexpr float kClosing = 0.38F, kClosed = 0.61F;
constexpr float kMmPerDegree = 1.4F;
// A network that is not sure says something nearer to the mean, so that all of its movements
// together come out smaller than true ones. So much larger they have about the right size
// (bench/vdm_bench.cc, `size`).
constexpr float kLively = 1.2F;

}  // namespace

float MouthFrame::Opening() const {
  const float lips = mouth[2] - mouth[4] + kMmPerDegree * mouth[11];
  return std::max(lips, 0.0F) * (1 - seal);
}

MouthFrame FrameOf(const MouthNet& net, const Eigen::Ref<const Eigen::VectorXf>& outputs) {
  MouthFrame frame;
  const auto value = [&](std::size_t row) { return outputs[static_cast<Eigen::Index>(row)]; };
  const float closed = 1 / (1 + std::exp(-value(net.closure_row())));
  const float u = std::clamp((closed - kClosing) / (kClosed - kClosing), 0.0F, 1.0F);
  frame.seal = u * u * (3 - 2 * u);

  const auto logits = outputs.tail(static_cast<Eigen::Index>(net.sounds.size()));
  const Eigen::VectorXf powers = (logits.array() - logits.maxCoeff()).exp();
  const float sum = powers.sum();
  for (const float power : powers) frame.sounds.push_back(power / sum);

  // Behind sealed lips of a pause the mouth goes home; behind those of p, b and m it stays.
  const float sounding = 1 - frame.seal * frame.sounds.front();
  for (std::size_t i = 0; i < kMouthParameters; ++i) {
    frame.mouth[i] = sounding * (net.means[i] + kLively * net.scales[i] * value(i));
  }
  frame.mouth[11] = std::max(frame.mouth[11], 0.0F);  // the jaw does not go up beyond its rest
  const float tongue =
      net.means[kMouthParameters] + net.scales[kMouthParameters] * value(kMouthParameters);
  frame.tongue = sounding * std::clamp(tongue, 0.0F, 1.0F);
  return frame;
}

}  // namespace vdm
