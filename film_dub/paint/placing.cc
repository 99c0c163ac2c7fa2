#include "film_dub/paint/placing.h"

#include <Eigen/Dense>
#include <cmath>

#include "face_fit/find/network/network_points.h"

namespace filmdub {
namespace {

// Nose, corners of the eyes, and the skin between: neither speech nor brows nor lids move them, and
// no silhouette is near, along which the network's points slide when a head turns.
constexpr facefit::PointIndex kUsed[] = {168, 6,  197, 195, 5,   4,   1,   2,   98,  327, 129,
                                         358, 33, 133, 362, 263, 118, 347, 101, 330, 8,   9};

}  // namespace

Placing PlaceOnFilm(std::span<const glm::vec2> drawn, std::span<const glm::vec2> seen) {
  Eigen::Matrix<double, std::size(kUsed), 3> from;
  Eigen::Matrix<double, std::size(kUsed), 2> to;
  for (std::size_t k = 0; k < std::size(kUsed); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    from.row(row) << drawn[kUsed[k]].x, drawn[kUsed[k]].y, 1;
    to.row(row) << seen[kUsed[k]].x, seen[kUsed[k]].y;
  }
  const Eigen::Matrix<double, 3, 2> found = from.colPivHouseholderQr().solve(to);
  Placing placing;
  for (int axis = 0; axis < 2; ++axis) {
    for (int k = 0; k < 3; ++k) {
      placing.m[static_cast<std::size_t>(3 * axis + k)] = static_cast<float>(found(k, axis));
    }
  }
  return placing;
}

std::vector<std::optional<Placing>> Smoothed(const std::vector<std::optional<Placing>>& placings) {
  constexpr int kReach = 4;       // pictures to either side
  constexpr float kWidth = 1.5F;  // of the bell
  std::vector<std::optional<Placing>> smooth(placings.size());
  for (std::size_t i = 0; i < placings.size(); ++i) {
    if (!placings[i]) continue;
    Placing mean{.m = {}};
    float sum = 0;
    for (const int step : {-1, 1}) {
      for (int away = step > 0 ? 0 : 1; away <= kReach; ++away) {
        const auto k = static_cast<std::ptrdiff_t>(i) + step * away;
        if (k < 0 || k >= std::ssize(placings) || !placings[static_cast<std::size_t>(k)]) break;
        const float weight = std::exp(-0.5F * static_cast<float>(away * away) / (kWidth * kWidth));
        for (std::size_t n = 0; n < mean.m.size(); ++n) {
          mean.m[n] += weight * placings[static_cast<std::size_t>(k)]->m[n];
        }
        sum += weight;
      }
    }
    for (float& number : mean.m) number /= sum;
    smooth[i] = mean;
  }
  return smooth;
}

}  // namespace filmdub
