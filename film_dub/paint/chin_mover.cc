#include "film_dub/paint/chin_mover.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace filmdub {
namespace {

// As parts of the distance between the eyes' outer corners: how far from the edge something moves,
// and what is left out.
constexpr float kBelow = 0.4F, kAbove = 0.2F;
constexpr float kTrembling = 0.01F;

float Fade(float t) {
  const float u = std::clamp(1 - t, 0.0F, 1.0F);
  return u * u * (3 - 2 * u);
}

/// An edge as heights over the way across.
class Edge {
 public:
  Edge(std::span<const glm::vec2> points, glm::vec2 along) {
    for (const glm::vec2 p : points) {
      points_.emplace_back(glm::dot(p, along), glm::dot(p, glm::vec2(-along.y, along.x)));
    }
    std::ranges::sort(points_, {}, &glm::vec2::x);
  }
  float first() const { return points_.front().x; }
  float last() const { return points_.back().x; }
  /// Between its ends.
  float At(float across) const {
    const auto behind = std::ranges::lower_bound(points_, across, {}, &glm::vec2::x);
    if (behind == points_.begin()) return points_.front().y;
    if (behind == points_.end()) return points_.back().y;
    const glm::vec2 a = *(behind - 1), b = *behind;
    return a.y + (b.y - a.y) * (across - a.x) / std::max(b.x - a.x, 1e-3F);
  }

 private:
  std::vector<glm::vec2> points_;
};

}  // namespace

float ChinReach(float unit) { return kBelow * unit; }

cv::Mat MoveChin(cv::Mat& colours, std::span<const glm::vec2> before,
                 std::span<const glm::vec2> after, glm::vec2 along, float unit) {
  const Edge old_edge(before, along), new_edge(after, along);
  const glm::vec2 down(-along.y, along.x);
  const float first = std::max(old_edge.first(), new_edge.first());
  const float last = std::min(old_edge.last(), new_edge.last());
  cv::Mat moved(colours.size(), CV_8U, cv::Scalar(0));
  if (last - first < 1) return moved;
  // Stretched by at most so much that no two places become one.
  const float most = 0.5F * std::min(kBelow, kAbove) * unit;
  cv::Mat from(colours.size(), CV_32FC2);
  for (int y = 0; y < colours.rows; ++y) {
    for (int x = 0; x < colours.cols; ++x) {
      const glm::vec2 p(x, y);
      from.at<cv::Vec2f>(y, x) = {p.x, p.y};
      const float u = glm::dot(p, along), v = glm::dot(p, down);
      const float across = 2 * (u - first) / (last - first) - 1;
      if (std::abs(across) >= 1) continue;
      const float edge = new_edge.At(u);
      const float off = (old_edge.At(u) - edge) * (1 - across * across);
      const float way = std::clamp(std::abs(off) - kTrembling * unit, 0.0F, most);
      const float share =
          Fade((v > edge ? v - edge : edge - v) / ((v > edge ? kBelow : kAbove) * unit));
      if (way * share < 0.02F) continue;
      const glm::vec2 source = p + std::copysign(way * share, off) * down;
      from.at<cv::Vec2f>(y, x) = {source.x, source.y};
      moved.at<std::uint8_t>(y, x) = 255;
    }
  }
  const cv::Mat whole = colours.clone();
  cv::remap(whole, colours, from, cv::noArray(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return moved;
}

}  // namespace filmdub
