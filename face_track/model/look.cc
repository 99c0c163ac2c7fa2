#include "face_track/model/look.h"

#include <cmath>
#include <glm/trigonometric.hpp>

namespace facetrack {

Lens Lens::Of(int width, int height, float field_degrees) {
  const float half = 0.5F * static_cast<float>(height);
  return {.focal = half / std::tan(glm::radians(0.5F * field_degrees)),
          .middle = {0.5F * static_cast<float>(width), half}};
}

glm::vec2 SeenTurn(const Pose& pose) {
  const fsm::Angles angles = fsm::HeadRotationOf(pose.turn);
  // A head that looks along the lens' axis beside it is seen from its inner side.
  const float right = glm::degrees(std::atan2(pose.place.x, -pose.place.z));
  const float up = glm::degrees(std::atan2(pose.place.y, -pose.place.z));
  return {angles[fsm::kDown] + up, angles[fsm::kToRight] + right};
}

glm::vec2 SeenAt(const SeenFace& face, const Lens& lens, const Pose& pose, std::size_t point,
                 glm::vec3 p) {
  const glm::vec2 seen = SeenTurn(pose);
  const float roll = -glm::radians(fsm::HeadRotationOf(pose.turn)[fsm::kTilted]);
  const glm::vec2 slide = face.Slide(point, seen.x, seen.y);
  const float c = std::cos(roll), s = std::sin(roll);
  const glm::vec3 q = pose(p);
  return lens.Project(q + glm::vec3(c * slide.x - s * slide.y, s * slide.x + c * slide.y, 0));
}

facefit::NetworkCrop CropOf(const Lens& lens, const Pose& pose) {
  constexpr glm::vec3 kMiddle(0, -4, 30);
  constexpr float kSide = 245;  // mm; the networks were trained on faces with so much around them
  const glm::vec3 q = pose(kMiddle);
  return {lens.Project(q), kSide * lens.focal / -q.z,
          glm::radians(fsm::HeadRotationOf(pose.turn)[fsm::kTilted])};
}

std::vector<glm::vec2> PlacesOf(const facefit::AttentiveFace& face) {
  std::vector<glm::vec2> places;
  for (const glm::vec3& p : face.face.points) places.emplace_back(p);
  for (const auto& iris : face.iris.InOrder()) places.push_back(iris[0]);
  return places;
}

}  // namespace facetrack
