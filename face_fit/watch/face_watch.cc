#include "face_fit/watch/face_watch.h"

#include "face_fit/find/network/face_finder.h"
#include "face_fit/image/plane.h"

namespace facefit {
namespace {

struct EyeLine {
  glm::vec2 middle;
  float angle_rad;
};
EyeLine EyeLineOf(const FoundFace& face) {
  const glm::vec2 across = face.AcrossEyes();
  return {face.PixelOf(point::kEyeOuterRight) + 0.5F * across, AngleOf(across)};
}

}  // namespace

void FaceWatch::FindPointsIn(const fsm::Image& frame, const NetworkCrop& crop) {
  last_ = attention_.Find(frame, crop);
  if (last_->face.certainty < kCertainFace) last_.reset();
}

void FaceWatch::Find(const fsm::Image& frame) {
  const auto faces = FindFaces(networks_, frame);
  if (faces.empty() || faces.front().certainty < kCertainFace) return;
  const FoundFace& face = faces.front();
  const EyeLine eyes = EyeLineOf(face);
  eyes_to_middle_ = Rotated(face.crop.centre - eyes.middle, -eyes.angle_rad);
  size_ = face.crop.size;
  FindPointsIn(frame, face.crop);
}

std::optional<FaceMeasures> FaceWatch::MeasureNext(const fsm::Image& frame) {
  if (last_) {
    const EyeLine eyes = EyeLineOf(last_->face);
    FindPointsIn(frame,
                 {eyes.middle + Rotated(eyes_to_middle_, eyes.angle_rad), size_, eyes.angle_rad});
  }
  if (!last_) Find(frame);
  if (!last_) return std::nullopt;
  if (first_.empty()) first_ = PointsInMm(last_->face);
  return Measure(*last_, first_);
}

}  // namespace facefit
