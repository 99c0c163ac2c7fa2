#pragma once

#include <Eigen/Dense>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace facetrack {

inline Eigen::Vector3f Of(glm::vec3 v) { return {v.x, v.y, v.z}; }
inline Eigen::Matrix3f Of(const glm::mat3& m) {
  Eigen::Matrix3f out;
  for (int c = 0; c < 3; ++c) out.col(c) = Of(m[c]);
  return out;
}
inline glm::mat3 Back(const Eigen::Matrix3f& m) {
  glm::mat3 out;
  for (int c = 0; c < 3; ++c) out[c] = {m(0, c), m(1, c), m(2, c)};
  return out;
}

}  // namespace facetrack
