#include "fsm/head/warp.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

namespace fsm {
namespace {

using Row = std::vector<double>;

/// Gaussian elimination; the last three columns are right-hand sides and receive the solution.
void Solve(std::vector<Row>& m) {
  const std::size_t n = m.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t best = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (std::abs(m[i][k]) > std::abs(m[best][k])) best = i;
    }
    if (!(std::abs(m[best][k]) > 1e-9)) {
      throw std::runtime_error("the points do not span space, so no warp goes through them");
    }
    std::swap(m[k], m[best]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double f = m[i][k] / m[k][k];
      if (f == 0) continue;
      for (std::size_t j = k; j < n + 3; ++j) m[i][j] -= f * m[k][j];
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t j = n; j < n + 3; ++j) m[k][j] /= m[k][k];
  }
}

}  // namespace

Warp::Warp(std::span<const WarpPoint> points, float smooth) {
  const std::size_t n = points.size();
  if (n < 4) throw std::runtime_error("a warp needs at least four points");
  std::vector<Row> m(n + 4, Row(n + 7, 0.0));
  for (std::size_t i = 0; i < n; ++i) {
    // The negative distance is positive definite beside an affine part, so that an addition to the
    // diagonal smooths.
    for (std::size_t j = 0; j < n; ++j) {
      m[i][j] = -static_cast<double>(glm::distance(points[i].position, points[j].position));
    }
    m[i][i] += static_cast<double>(smooth);
    const double p[4] = {1, points[i].position.x, points[i].position.y, points[i].position.z};
    for (std::size_t c = 0; c < 4; ++c) m[i][n + c] = m[n + c][i] = p[c];
    for (int c = 0; c < 3; ++c)
      m[i][n + 4 + static_cast<std::size_t>(c)] = points[i].displacement[c];
  }
  Solve(m);
  const auto solution = [&](std::size_t row) {
    return glm::vec3(m[row][n + 4], m[row][n + 5], m[row][n + 6]);
  };
  for (std::size_t i = 0; i < n; ++i) {
    centres_.push_back(points[i].position);
    weights_.push_back(solution(i));
  }
  for (std::size_t c = 0; c < 4; ++c) affine_[c] = solution(n + c);
}

glm::vec3 Warp::Motion(glm::vec3 p) const {
  glm::vec3 sum = affine_[0] + affine_[1] * p.x + affine_[2] * p.y + affine_[3] * p.z;
  for (std::size_t i = 0; i < centres_.size(); ++i)
    sum -= weights_[i] * glm::distance(p, centres_[i]);
  return sum;
}

}  // namespace fsm
