#include "face_fit/fit/camera_pose.h"

#include <cmath>
#include <glm/matrix.hpp>

namespace facefit {
namespace {

constexpr glm::vec3 kMiddle{0, -10, 20};  ///< centre of the head's rotation

}  // namespace

glm::mat3 CameraPose::Rotation() const {
  const float cx = std::cos(rotation_rad.x), sx = std::sin(rotation_rad.x);
  const float cy = std::cos(rotation_rad.y), sy = std::sin(rotation_rad.y);
  const float cz = std::cos(rotation_rad.z), sz = std::sin(rotation_rad.z);
  const glm::mat3 x(1, 0, 0, 0, cx, sx, 0, -sx, cx);
  const glm::mat3 y(cy, 0, -sy, 0, 1, 0, sy, 0, cy);
  const glm::mat3 z(cz, sz, 0, -sz, cz, 0, 0, 0, 1);
  return z * x * y;
}
glm::vec3 CameraPose::ToCamera(glm::vec3 p) const { return Rotation() * (p - kMiddle) + kMiddle; }
std::vector<glm::vec3> CameraPose::ToCamera(std::span<const glm::vec3> positions) const {
  const glm::mat3 rotation = Rotation();
  std::vector<glm::vec3> in_camera;
  for (const glm::vec3& p : positions) in_camera.push_back(rotation * (p - kMiddle) + kMiddle);
  return in_camera;
}
glm::vec3 CameraPose::FromCamera(glm::vec3 q) const {
  return glm::transpose(Rotation()) * (q - kMiddle) + kMiddle;
}
glm::vec3 CameraPose::TowardsCamera() const {
  return glm::transpose(Rotation()) * glm::vec3(0, 0, 1);
}
glm::vec2 CameraPose::Project(glm::vec3 q) const {
  return centre_px + focal_px / (kCameraDepthMm - q.z) * glm::vec2(q.x, -q.y);
}
glm::vec3 CameraPose::Unproject(glm::vec2 pixel, float z) const {
  const glm::vec2 d = (pixel - centre_px) * ((kCameraDepthMm - z) / focal_px);
  return {d.x, -d.y, z};
}
std::vector<glm::vec3> CameraPose::ToScreen(std::span<const glm::vec3> positions) const {
  std::vector<glm::vec3> screen = ToCamera(positions);
  for (glm::vec3& q : screen) q = glm::vec3(Project(q), q.z);
  return screen;
}
float CameraPose::PixelsPerMm() const { return focal_px / (kCameraDepthMm - kFaceDepthMm); }

}  // namespace facefit
