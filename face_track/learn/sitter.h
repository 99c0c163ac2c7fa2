#pragma once

#include <string>
#include <vector>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/find/network/attention_points.h"
#include "face_fit/find/network/face_networks.h"
#include "face_track/learn/head_painter.h"

namespace facetrack {

/// A face of nobody: a built-in one with its sliders moved by chance; 0 and 1 as they are.
std::unique_ptr<fsm::Head> SomeHead(std::size_t number);

/// One head before the network. What it is made with outlives it. Throws std::runtime_error where
/// the network sees no face.
class Sitter {
 public:
  Sitter(std::unique_ptr<fsm::Head> head, facefit::FaceNetworks& networks,
         facefit::AttentionNetwork& attention, HeadPainter& painter);

  struct Sight {
    Pose pose;  ///< of a head whose eyes are as far apart as in tables
    std::vector<glm::vec2> places;
    std::vector<float> depth;  ///< as the network gives it, mm
    fsm::HeadVertices vertices;
    fsm::Image picture;
  };
  Sight Look(const fsm::FaceState& state);

  const Points& rest() const { return rest_; }
  const std::vector<float>& depth() const { return depth_; }
  Lens lens() const { return painter_.lens(); }

  /// How far from where they are the points are seen on the turned head, mm of the view.
  std::vector<glm::vec2> Slides(float down, float right);
  struct Motion {
    Points moved;                 ///< in the head's frame
    std::vector<glm::vec2> seen;  ///< likewise, if their depth stayed as it is
  };
  /// By how much a channel moves them.
  Motion MotionOf(const Channel& channel, float dose);

 private:
  float DepthOf(std::size_t point, const fsm::HeadVertices& vertices) const;

  facefit::AttentionNetwork& attention_;
  HeadPainter& painter_;
  facefit::ObservedHead base_;
  float scale_ = 1;
  Points rest_;
  std::vector<float> depth_;
};

/// The face with one channel at a dose and nothing else.
fsm::FaceState StateOf(const Channel& channel, float dose);

}  // namespace facetrack
