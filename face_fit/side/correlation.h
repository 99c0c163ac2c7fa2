#pragma once

#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <span>

namespace facefit {

/// Subtracts mean and linear trend. `at(i)`: the position of a value; positions lie evenly about
/// (0, 0), on a line along x or in a square.
void RemoveTrend(std::span<float> values, auto at) {
  float mean = 0, squares = 0;
  glm::vec2 slope(0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const glm::vec2 p = at(i);
    mean += values[i];
    slope += p * values[i];
    squares += p.x * p.x;
  }
  mean /= static_cast<float>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] -= mean + glm::dot(slope, at(i)) / squares;
  }
}

/// Sums of products of two lists of equal length.
struct ProductSums {
  ProductSums(std::span<const float> a, std::span<const float> b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      aa += a[i] * a[i];
      bb += b[i] * b[i];
      ab += a[i] * b[i];
    }
  }
  float aa = 0, bb = 0, ab = 0;
};

}  // namespace facefit
