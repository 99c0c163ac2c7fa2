#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "face_track/model/look.h"

namespace facetrack {

/// What a face does in one picture.
struct Doing {
  Pose pose;
  std::vector<float> doses;  ///< of each channel of the table
  float miss = 0;            ///< mm by which the points lie elsewhere, their median
};

/// The points with doses, millimetres.
Points Moved(const SeenFace& face, const Points& rest, const std::vector<float>& doses);

/// Finds pose and doses that show a person's points where the network sees them: least squares with
/// bounds, all unknowns at once, by Gauss's and Newton's method. Points count by how surely they
/// are seen, and by their distance, not its square, where they are far off (Huber). Doses are drawn
/// to 0 a little, so that of channels that look alike one is taken and not all, and both sides' to
/// each other. Where the turn is known, what heads differ in as they do that (SeenFace::variations)
/// is found with them and tells nothing of doses; which units there are is searched for first
/// (ChooseUnits), and small doses are drawn to 0 more than large ones; the turn may be a little off
/// as the doses are found, and is returned as it was given. Pure; thread: any.
class FrameFit {
 public:
  FrameFit(const SeenFace& face, const Lens& lens);

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);  ///< no channel
  enum class What { kPose, kPoseAndDoses, kDoses };                   ///< kDoses: the turn stays
  /// From `start`, whose doses are all there.
  Doing Solve(const Points& rest, std::span<const glm::vec2> places, const Doing& start,
              What what) const;
  /// A first guess, by the eyes' outer corners alone.
  Doing Guess(std::span<const glm::vec2> places) const;
  /// Where the points lie on the face in the head's frame, at the depth they have there by `doing`.
  Points OnFace(const Points& rest, std::span<const glm::vec2> places, const Doing& doing) const;

  const SeenFace& face() const { return face_; }
  const Lens& lens() const { return lens_; }

 private:
  const SeenFace& face_;
  Lens lens_;
  std::vector<std::size_t> opposite_;  ///< of each channel that of the other side; kNone
};

}  // namespace facetrack
