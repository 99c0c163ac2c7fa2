#include "film_dub/paint/placing.h"

#include <Eigen/Dense>
#include <cmath>
#include <glm/geometric.hpp>

#include "face_fit/find/network/network_points.h"

namespace filmdub {
namespace {

// Nose, corners of the eyes, and the skin between: neither speech nor brows nor lids move them, and
// no silhouette is near, along which the network's points slide when a head turns.
constexpr facefit::PointIndex kSteady[] = {168, 6,  197, 195, 5,   4,   1,   2,   98,  327, 129,
                                           358, 33, 133, 362, 263, 118, 347, 101, 330, 8,   9};

// Across the face the chin, too: the jaw drops along it. Without them the far side of a turned
// head's chin would lie where a slope found between nose and eyes happens to lead.
constexpr facefit::PointIndex kAcross[] = {168, 6,   197, 195, 5,   4,   1,   2,   98,  327,
                                           129, 358, 33,  133, 362, 263, 118, 347, 101, 330,
                                           8,   9,   152, 148, 377, 176, 400, 149, 378};

/// Factors of x, y and 1 by which drawn points give how far the seen ones lie along an axis.
Eigen::Vector3d LinearFit(std::span<const glm::vec2> drawn, std::span<const glm::vec2> seen,
                          glm::vec2 axis, std::span<const facefit::PointIndex> used) {
  Eigen::MatrixX3d from(used.size(), 3);
  Eigen::VectorXd to(used.size());
  for (std::size_t k = 0; k < used.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    from.row(row) << static_cast<double>(drawn[used[k]].x), static_cast<double>(drawn[used[k]].y),
        1;
    to[row] = static_cast<double>(glm::dot(seen[used[k]], axis));
  }
  return from.colPivHouseholderQr().solve(to);
}

}  // namespace

Placing PlaceOnFilm(std::span<const glm::vec2> drawn, std::span<const glm::vec2> seen) {
  const auto along =
      glm::normalize(seen[facefit::point::kEyeOuterLeft] - seen[facefit::point::kEyeOuterRight]);
  const glm::vec2 down(-along.y, along.x);
  const Eigen::Vector3d across_map = LinearFit(drawn, seen, along, kAcross);
  const Eigen::Vector3d down_map = LinearFit(drawn, seen, down, kSteady);
  Placing placing;
  for (int k = 0; k < 3; ++k) {
    const auto a = static_cast<float>(across_map[k]), d = static_cast<float>(down_map[k]);
    placing.m[static_cast<std::size_t>(k)] = along.x * a + down.x * d;
    placing.m[static_cast<std::size_t>(3 + k)] = along.y * a + down.y * d;
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
