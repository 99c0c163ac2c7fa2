#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "face_track/model/seen_face.h"

namespace facetrack {

/// A face's other side: heads are symmetric, so what is seen of one side holds of the other, too.
struct Mirroring {
  std::vector<std::size_t> points;    ///< of each point its opposite
  std::vector<std::size_t> channels;  ///< of each channel that of the other side; itself if of both
  static Mirroring Of(const SeenFace& face);
  /// A face that turns its eyes to the right is in the mirror one that turns them to the left.
  static std::size_t Dose(const Channel& channel, std::size_t index);
  /// Has an opposite, or lies in the middle.
  bool IsPaired(const SeenFace& face, std::size_t point) const;
};

/// In which ways heads differ in what their units look like: principal components of what each
/// head's points do otherwise than those of all heads on the mean. Which of them is seen in a
/// picture tells little of units, since another head does it by itself.
class Variations {
 public:
  /// What is seen of one head: by channel, dose and point, mm in the head's frame.
  using Seen = std::vector<std::vector<std::vector<glm::vec2>>>;
  void Add(Seen seen) { heads_.push_back(std::move(seen)); }
  /// Sets what `to` says of them. REQUIRES: a head.
  void Teach(const Mirroring& mirroring, SeenFace& to) const;

 private:
  std::vector<Seen> heads_;
};

}  // namespace facetrack
