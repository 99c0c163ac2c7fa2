#include "face_fit/watch/face_watch.h"

#include <cmath>

#include "face_fit/picture/plane.h"

namespace facefit {
namespace {

struct EyeLine {
  glm::vec2 middle;
  float angle;
};
EyeLine EyesOf(const FoundFace& face) {
  const glm::vec2 right = face.PixelOf(point::kEyeOuterRight),
                  left = face.PixelOf(point::kEyeOuterLeft);
  return {0.5F * (right + left), std::atan2(left.y - right.y, left.x - right.x)};
}

}  // namespace

void FaceWatch::FindPointsIn(const fsm::Image& picture, const NetworkCrop& crop) {
  last_ = FindAttentivePoints(attention_, picture, crop);
  if (last_->face.certainty < kCertainFace) last_.reset();
}

void FaceWatch::Find(const fsm::Image& picture) {
  const auto faces = FindFaces(networks_, picture);
  if (faces.empty() || faces.front().certainty < kCertainFace) return;
  const FoundFace& face = faces.front();
  const EyeLine eyes = EyesOf(face);
  eyes_to_middle_ = Rotated(face.crop.centre - eyes.middle, -eyes.angle);
  size_ = face.crop.size;
  FindPointsIn(picture, face.crop);
}

std::optional<FaceMeasures> FaceWatch::MeasureNext(const fsm::Image& picture) {
  if (last_) {
    const EyeLine eyes = EyesOf(last_->face);
    FindPointsIn(picture, {eyes.middle + Rotated(eyes_to_middle_, eyes.angle), size_, eyes.angle});
  }
  if (!last_) Find(picture);
  if (!last_) return std::nullopt;
  if (first_.empty()) first_ = PointsInMm(last_->face);
  return Measure(*last_, first_);
}

}  // namespace facefit
