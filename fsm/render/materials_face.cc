// What of the materials follows eyes and mouth, frame by frame.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "fsm/render/materials.h"

namespace fsm {

void Materials::SetEyePictures(const HeadBuffers& head, const Sided<EyeFrame>& eyes,
                               const glm::mat3& rest_to_world) {
  for (const auto& [name, place] :
       {std::pair("irises", &EyePicture::iris), std::pair("balls", &EyePicture::ball)}) {
    const glm::vec4 squares[] = {head.eye_pictures()->right.*place,
                                 head.eye_pictures()->left.*place};
    gl_.Uniform4fv(eye_.Uniform(name), 2, glm::value_ptr(squares[0]));
  }
  glm::vec4 open[2];
  for (const Side side : kSides) {
    const EyeFrame& rest = head.resting_eyes()[side];
    const EyeFrame& eye = eyes[side];
    open[static_cast<std::size_t>(side)] = {rest.upper_lid_y - rest.centre.y,
                                            rest.lower_lid_y - rest.centre.y,
                                            eye.upper_lid_y - eye.centre.y, kBallSpan * eye.radius};
  }
  gl_.Uniform4fv(eye_.Uniform("open"), 2, glm::value_ptr(open[0]));
  const glm::mat3 world_to_head = glm::inverse(rest_to_world);
  gl_.UniformMatrix3fv(eye_.Uniform("world_to_head"), 1, GL_FALSE, glm::value_ptr(world_to_head));
}

void Materials::SetMouth(const View& view, const HeadBuffers& head, const HeadVertices& vertices,
                         glm::vec3 key_direction) {
  const auto opening = head.mouth().Measure(vertices);
  has_mouth_ = opening.has_value();
  lips_shut_ = opening && opening->IsShut();
  float gap = 0, dropped = 0;
  if (opening) {
    constexpr std::size_t kMiddle = MouthFinder::kColumns / 2;
    gap = opening->lips[kMiddle].y - opening->lips[kMiddle + MouthFinder::kColumns].y;
    // At rest the lower incisors stand behind the upper ones.
    constexpr float kOverlap = 1.3F;
    dropped = std::max(opening->teeth.x - opening->teeth.y + kOverlap, 0.0F);
  }
  // Said of every head: the one drawn before it may have had its mouth open.
  for (const auto& photo : photo_) {
    if (!photo) continue;
    gl_.UseProgram(photo->id());
    gl_.Uniform1f(photo->Uniform("lips_apart"), glm::smoothstep(0.4F, 2.5F, gap));
    gl_.Uniform1f(photo->Uniform("chin_y"), head.chin_y());
    gl_.Uniform1f(photo->Uniform("chin_drop"), dropped);
  }
  if (!opening) return;
  const glm::mat3 turn(view.figure_to_world);
  const glm::mat3 to_world =
      turn / glm::length(turn[0]) * glm::transpose(glm::mat3(opening->to_mouth));
  glm::vec3 key = glm::transpose(to_world) * key_direction;
  // The lamp is large, so most of what lips leave of its light comes from straight ahead; photos
  // are taken with the light behind the camera, more or less.
  const bool photo = head.photo() != nullptr;
  const auto number = [this, photo](const char* of_photo, const char* of_paint) {
    return appearance_.Number(photo ? of_photo : of_paint);
  };
  key = glm::normalize(glm::mix(key, appearance_.Color("mouth_key_from"),
                                number("photo_mouth_ahead", "mouth_key_ahead")));
  gl_.UseProgram(mouth_.id());
  gl_.UniformMatrix4fv(mouth_.Uniform("to_mouth"), 1, GL_FALSE, glm::value_ptr(opening->to_mouth));
  gl_.UniformMatrix3fv(mouth_.Uniform("mouth_to_world"), 1, GL_FALSE, glm::value_ptr(to_world));
  gl_.Uniform3fv(mouth_.Uniform("lips"), 2 * MouthFinder::kColumns,
                 glm::value_ptr(opening->lips[0]));
  gl_.Uniform4f(mouth_.Uniform("mouth_edges"), opening->corners.x, opening->corners.y,
                opening->teeth.x, opening->teeth.y);
  gl_.Uniform1f(mouth_.Uniform("front_gain"), number("photo_mouth_front", "mouth_front"));
  gl_.Uniform1f(mouth_.Uniform("deep_gain"), number("photo_mouth_deep", "mouth_deep"));
  gl_.Uniform3fv(mouth_.Uniform("mouth_key"), 1, glm::value_ptr(key));
}

void Materials::SetEyes(const View& view, const HeadBuffers& head, const HeadVertices& vertices,
                        const glm::mat3& rest_to_world, float brightness) {
  const auto eyes = head.eyes().Measure(vertices);
  SetEyeballs(view, eyes, head.eye_geometry());
  // The white of a grey photo is grey, and so is the flesh beside it.
  const glm::vec3 white = head.eye_geometry().white_colour;
  const bool grey = std::abs(white.r - white.g) + std::abs(white.g - white.b) < 0.02F * white.g;
  const bool pictured = head.photo() && head.eye_pictures();
  gl_.Uniform1f(eye_.Uniform("flesh_red"), grey ? 0.0F : 1.0F);
  gl_.Uniform1f(eye_.Uniform("photo_brightness"), head.photo() ? brightness : 0.0F);
  gl_.Uniform1f(eye_.Uniform("iris_span"), pictured ? kIrisSpan : 0.0F);
  gl_.Uniform1i(eye_.Uniform("photo"), 1);
  if (pictured) SetEyePictures(head, eyes, rest_to_world);
}

void Materials::SetEyeballs(const View& view, const Sided<EyeFrame>& eyes,
                            const EyeGeometry& place) {
  const glm::mat3 turn(view.figure_to_world);
  const float scale = glm::length(turn[0]);
  glm::vec4 balls[2];
  glm::vec3 gazes[2];
  glm::vec4 lids[2];
  for (const Side side : kSides) {
    const EyeFrame& eye = eyes[side];
    const auto i = static_cast<std::size_t>(side);
    const auto to_world = [&view](const glm::vec3& p) {
      return glm::vec3(view.figure_to_world * glm::vec4(p, 1.0F));
    };
    balls[i] = glm::vec4(to_world(eye.centre), eye.radius * scale);
    gazes[i] = turn * eye.gaze / scale;
    const glm::vec3 front = eye.centre + eye.gaze * eye.radius;
    lids[i].x = to_world({front.x, eye.upper_lid_y, front.z}).y;
    lids[i].y = to_world({front.x, eye.lower_lid_y, front.z}).y;
  }
  gl_.UseProgram(eye_.id());
  gl_.Uniform4fv(eye_.Uniform("ball"), 2, glm::value_ptr(balls[0]));
  gl_.Uniform3fv(eye_.Uniform("gaze"), 2, glm::value_ptr(gazes[0]));
  gl_.Uniform4fv(eye_.Uniform("lids"), 2, glm::value_ptr(lids[0]));
  const EyeFrame& first = eyes.right;  // both are as large
  const float plane = std::sqrt(
      std::max(first.radius * first.radius - first.iris_radius * first.iris_radius, 1.0F));
  const glm::vec4 iris(first.iris_radius * scale, place.pupil_radius / place.iris_radius,
                       plane * scale, 0.0F);
  gl_.Uniform4fv(eye_.Uniform("iris"), 1, glm::value_ptr(iris));
  gl_.Uniform3fv(eye_.Uniform("iris_color"), 1, glm::value_ptr(place.iris_colour));
  gl_.Uniform3fv(eye_.Uniform("white_color"), 1, glm::value_ptr(place.white_colour));
  gl_.Uniform1f(eye_.Uniform("figure_scale"), scale);
}

}  // namespace fsm
