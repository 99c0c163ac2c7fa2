#include "fsm/render/camera.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

namespace fsm {
namespace {

/// Vertical range in view at the depth of the face, mm: from below the collar to above the hair.
constexpr float kFramedBottom = -172.0f;
constexpr float kFramedTop = 158.0f;
/// Least width that stays in view, mm: the head with its hair.
constexpr float kFramedWidth = 250.0f;
constexpr float kFaceDepth = 50.0f;
/// The figure turns and scales about the root of the neck, so that it stays in its place.
constexpr glm::vec3 kPivot{0.0f, -60.0f, 0.0f};

constexpr glm::vec3 kXAxis{1, 0, 0}, kYAxis{0, 1, 0}, kZAxis{0, 0, 1};

/// Rotates about one axis of the figure; positive z leans to the viewer's right.
glm::mat4 Turned(const glm::mat4& from, const Figure& placed, int axis) {
  const glm::vec3 axes[] = {kXAxis, kYAxis, -kZAxis};
  const auto i = static_cast<std::size_t>(axis);
  return glm::rotate(from, glm::radians(placed.rotation[i]), axes[i]);
}

float ScaleOf(const Figure& placed) { return std::clamp(placed.scale, 0.01f, 100.0f); }
float DistanceOf(const Camera& camera) { return std::clamp(camera.distance, 0.2f, 10.0f); }

/// Returns the figure's translation; `half_view` is half the view's longer side in millimetres.
glm::vec3 MovedBy(const Figure& placed, const Camera& camera, float half_view) {
  const float unit = camera.moves_by_half_views ? half_view : 1.0f;
  return {unit * placed.translation[0], unit * placed.translation[1], 0.0f};
}

FrameCamera FrameParallel(const Figure& placed, const Camera& camera, const ParallelView& parallel,
                          float aspect, int height) {
  constexpr float kFar = 20000.0f;  // so far that light and highlights are almost parallel
  const glm::vec3 centre = parallel.centre;
  const float half = parallel.half_mm * DistanceOf(camera);
  const float half_width = half * std::min(aspect, 1.0f),
              half_height = half / std::max(aspect, 1.0f);
  const float angle = glm::radians(camera.angle_degrees);
  const glm::vec3 aim = centre + glm::vec3(0.0f, camera.height_mm, 0.0f);
  FrameCamera view;
  view.eye = aim + kFar * glm::vec3(std::sin(angle), 0.0f, std::cos(angle));
  view.world_to_clip =
      glm::ortho(-half_width, half_width, -half_height, half_height, 0.0f, 2 * kFar) *
      glm::lookAt(view.eye, aim, kYAxis);
  glm::mat4 figure = glm::translate(glm::mat4(1.0f), centre + MovedBy(placed, camera, half));
  figure = glm::scale(figure, glm::vec3(ScaleOf(placed)));
  for (const int axis : {0, 1, 2}) figure = Turned(figure, placed, axis);
  view.figure_to_world = glm::translate(figure, -centre);
  view.samples_per_mm = static_cast<float>(height) / half_height * ScaleOf(placed);
  return view;
}

}  // namespace

FrameCamera ViewOfPortrait(const Figure& placed, const Camera& camera, int width, int height,
                           const std::optional<ParallelView>& parallel) {
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  if (parallel) return FrameParallel(placed, camera, *parallel, aspect, height);
  const float framed_height = std::max(kFramedTop - kFramedBottom, kFramedWidth / aspect);
  const float half_angle = glm::radians(std::clamp(camera.field_degrees, 5.0f, 90.0f) / 2);
  const float portrait = framed_height / 2 / std::tan(half_angle);
  const float distance = portrait * DistanceOf(camera);
  const float middle = (kFramedTop + kFramedBottom) / 2 + camera.height_mm;
  const float angle = glm::radians(camera.angle_degrees);

  // From the side, the head's own axis stays in the middle of the view.
  FrameCamera view;
  const glm::vec3 outward(std::sin(angle), 0.0f, std::cos(angle));
  view.eye = glm::vec3(0.0f, middle, 0.0f) + outward * (kFaceDepth + distance);
  view.world_to_clip =
      glm::perspective(2 * half_angle, aspect, distance * 0.2f, distance * 5.0f + 500.0f) *
      glm::lookAt(view.eye, {0.0f, middle, 0.0f}, {0.0f, 1.0f, 0.0f});

  const float half_view = DistanceOf(camera) * framed_height / 2 * std::max(aspect, 1.0f);
  glm::mat4 figure = glm::translate(glm::mat4(1.0f), kPivot + MovedBy(placed, camera, half_view));
  for (const int axis : {2, 1, 0}) figure = Turned(figure, placed, axis);
  figure = glm::scale(figure, glm::vec3(ScaleOf(placed)));
  view.figure_to_world = glm::translate(figure, -kPivot);
  view.samples_per_mm =
      2 * static_cast<float>(height) / (framed_height * DistanceOf(camera)) * ScaleOf(placed);
  return view;
}

}  // namespace fsm
