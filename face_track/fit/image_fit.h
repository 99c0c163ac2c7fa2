#pragma once

#include <array>
#include <vector>

#include "face_track/fit/face_look.h"
#include "face_track/fit/frame_fit.h"

namespace facetrack {

/// How a person's face looked at rest, and its pose in another picture by that: what the network's
/// points say of a turn is off by one or two degrees, in its own way for each face. The template is
/// what is above the mouth, without the eyes; it is moved by pose and doses until it lies on what
/// looks like it (Lucas and Kanade 1981, with robust weights); the upper forehead, across which
/// hair falls, is judged for likeness alone. How deep the face is one picture does not show: a few
/// numbers that say so are found with the poses, from picture to picture.
class ImageFit {
 public:
  struct View {
    const FaceLook& look;
    const Pose& pose;
  };
  /// Of `views` the first tells what is seen of the face; how that looks is the mean of all.
  /// REQUIRES: one or more.
  ImageFit(const SeenFace& face, const Lens& lens, const Points& rest,
           const std::vector<View>& views);

  struct Found {
    Pose pose;
    float like = 0;  ///< correlation with the template; 0 where too little of it is in view
  };
  /// Of at least that likeness a picture shows this face, and the pose is better than the
  /// network's.
  static constexpr float kAlike = 0.5F;
  Found Solve(const Points& rest, const FaceLook& look, const Doing& start);

 private:
  /// The depth is another by parts of: itself, x, y, and their squares.
  static constexpr std::size_t kForms = 5;
  struct Sample {
    std::array<std::size_t, 3> near;  ///< network's points beside it
    std::array<float, 3> part;
    glm::vec3 off;  ///< from where these parts of them lie
    bool hair;      ///< hair may hang there: judged for likeness alone
    glm::vec3 normal;
    glm::vec3 ray;                   ///< towards the camera of the template, z = 1
    std::array<float, kForms> form;  ///< how much each number of the depth moves it along the ray
    std::array<float, FaceLook::kLevels> look;
  };
  struct Guess;
  struct Comparison;
  Comparison Compare(const std::vector<glm::vec3>& at, const FaceLook& look, std::size_t level,
                     const Guess& guess) const;

  const SeenFace& face_;
  Lens lens_;
  std::vector<Sample> samples_;
  // What is known of the depth: the numbers, and the inverse of their covariance, by rows.
  std::array<float, kForms> form_{};
  std::array<float, kForms * kForms> sure_{};
  glm::mat3 learned_;  // the turn of the picture that told of it last
};

}  // namespace facetrack
