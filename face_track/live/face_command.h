#pragma once

#include <map>
#include <string>

#include "face_track/follow/face_line.h"

namespace facetrack {

/// What a followed face does as values of the agent's slot AU: units, and the codes by which AU
/// turns head and eyes. Only what has changed since the last value is said.
class FaceCommand {
 public:
  explicit FaceCommand(const SeenFace& face) : face_(face) {}
  /// The value for this line, reached within `ms`; "" where nothing has changed. `mirrored`: the
  /// agent moves as the person's image in a mirror would, its left side as the person's right.
  std::string Next(const FaceLine& line, bool mirrored, double ms);
  /// Everything said so far goes back to rest.
  std::string Rest(double ms);

 private:
  std::string Say(const std::map<std::string, float>& wanted, double ms);
  const SeenFace& face_;
  std::map<std::string, float> said_;  // strengths by the names that AU takes
};

}  // namespace facetrack
