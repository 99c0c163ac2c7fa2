#include "hypermask/project/face_warp.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace hypermask {

FaceWarp::FaceWarp(MaskLayout layout, int width, int height)
    : layout_(std::move(layout)), drawn_(fsm::FilledImage(width, height, fsm::kBlack)) {}

PlaneMap FaceWarp::PictureToMask(const MaskLayout& layout, int width, int height) {
  const double scale = layout.picture_height / height;
  PlaneMap map;
  map << scale, 0, layout.picture.x() - 0.5 * scale * (width - 1),  //
      0, scale, layout.picture.y() - 0.5 * scale * (height - 1),    //
      0, 0, 1;
  return map;
}

void FaceWarp::SetFace(const fsm::Image& face) {
  assert(face.width > 0 && face.height > 0);
  if (face.width != fade_width_ || face.height != fade_height_) {
    fade_width_ = face.width;
    fade_height_ = face.height;
    fade_.resize(face.rgba.size() / 4);
    const PlaneMap map = PictureToMask(layout_, face.width, face.height);
    for (int y = 0; y < face.height; ++y) {
      for (int x = 0; x < face.width; ++x) {
        const double radius = Apply(map, Point(x, y)).cwiseQuotient(layout_.oval).norm();
        const double fade = std::clamp((1 - radius) / kFade, 0.0, 1.0);
        fade_[face.Index(x, y)] = static_cast<float>(fade * fade * (3 - 2 * fade));
      }
    }
  }
  face_ = face;
  for (std::size_t i = 0; i < fade_.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      std::uint8_t& value = face_.rgba[4 * i + c];
      value = static_cast<std::uint8_t>(std::lround(fade_[i] * static_cast<float>(value)));
    }
    face_.rgba[4 * i + 3] = 255;
  }
}

const fsm::Image& FaceWarp::Draw(const PlaneMap* map) {
  cv::Mat out(drawn_.height, drawn_.width, CV_8UC4, drawn_.rgba.data());
  const cv::Scalar black(0, 0, 0, 255);
  if (!map || face_.rgba.empty()) {
    out.setTo(black);
    return drawn_;
  }
  const cv::Mat face(face_.height, face_.width, CV_8UC4, face_.rgba.data());
  const PlaneMap whole = *map * PictureToMask(layout_, face_.width, face_.height);
  const cv::Matx33d matrix(whole(0, 0), whole(0, 1), whole(0, 2), whole(1, 0), whole(1, 1),
                           whole(1, 2), whole(2, 0), whole(2, 1), whole(2, 2));
  cv::warpPerspective(face, out, matrix, out.size(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, black);
  return drawn_;
}

}  // namespace hypermask
