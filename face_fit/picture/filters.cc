#include "face_fit/picture/filters.h"

#include <algorithm>
#include <glm/common.hpp>
#include <opencv2/imgproc.hpp>
#include <span>

namespace facefit {
namespace {

/// Views of our pictures, which outlive them; OpenCV does not write into those made from const.
cv::Mat View(const FloatImage& image) {
  return {image.height, image.width, CV_32F, const_cast<float*>(image.at.data())};
}
cv::Mat View(const fsm::Image& image) {
  return {image.height, image.width, CV_8UC4, const_cast<std::uint8_t*>(image.rgba.data())};
}

/// OpenCV would otherwise start threads of its own.
void StayOnThisThread() {
  static const bool done = (cv::setNumThreads(1), true);
  (void)done;
}

}  // namespace

FloatImage Blurred(const FloatImage& image, int reach) {
  StayOnThisThread();
  FloatImage out(image.width, image.height);
  cv::Mat sums = View(out);
  const int side = 2 * reach + 1;
  cv::boxFilter(View(image), sums, CV_32F, {side, side}, {-1, -1}, false, cv::BORDER_CONSTANT);
  const auto within = [reach](int i, int size) {
    return static_cast<float>(std::min(i + reach, size - 1) - std::max(i - reach, 0) + 1);
  };
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      out.at[out.Index(x, y)] /= within(x, out.width) * within(y, out.height);
    }
  }
  return out;
}

FloatImage Closed(const FloatImage& image, int reach) {
  StayOnThisThread();
  FloatImage out(image.width, image.height);
  cv::Mat closed = View(out);
  const int side = 2 * reach + 1;
  cv::morphologyEx(View(image), closed, cv::MORPH_CLOSE,
                   cv::getStructuringElement(cv::MORPH_RECT, {side, side}));
  return out;
}

void FillHoles(FloatImage& image) {
  StayOnThisThread();
  // With a border of one pixel all that is outside is connected.
  cv::Mat covered;
  cv::copyMakeBorder(View(image) > 0, covered, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  constexpr int kOutside = 128;
  cv::floodFill(covered, {0, 0}, cv::Scalar(kOutside));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image.at[image.Index(x, y)] = covered.at<std::uint8_t>(y + 1, x + 1) == kOutside ? 0.F : 1.F;
    }
  }
}

void KeepConnected(glm::ivec2 to, FloatImage& image) {
  StayOnThisThread();
  constexpr float kLeast = 0.1F;
  const glm::ivec2 seed = glm::clamp(to, glm::ivec2(0), glm::ivec2(image.width, image.height) - 1);
  if (image.at[image.Index(seed.x, seed.y)] < kLeast) return;
  cv::Mat present = View(image) >= kLeast;  // 255 where it is
  constexpr int kKept = 128;
  cv::floodFill(present, {seed.x, seed.y}, cv::Scalar(kKept), nullptr, {}, {}, 8);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (present.at<std::uint8_t>(y, x) != kKept) image.at[image.Index(x, y)] = 0;
    }
  }
}

std::vector<std::size_t> NearestAbove(const FloatImage& image, float threshold) {
  StayOnThisThread();
  cv::Mat distance, label;
  const cv::Mat unknown = View(image) < threshold;
  cv::distanceTransform(unknown, distance, label, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  std::vector<std::size_t> of_label(image.at.size() + 1), nearest(image.at.size());
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (image.at[i] >= threshold)
      of_label[static_cast<std::size_t>(label.begin<int>()[static_cast<int>(i)])] = i;
  }
  std::ranges::transform(std::span(label.ptr<int>(), nearest.size()), nearest.begin(),
                         [&](int k) { return of_label[static_cast<std::size_t>(k)]; });
  return nearest;
}

fsm::Image ScaledDown(const fsm::Image& image, int width, int height) {
  StayOnThisThread();
  fsm::Image out = fsm::FilledImage(width, height);
  cv::Mat scaled = View(out);
  cv::resize(View(image), scaled, scaled.size(), 0, 0, cv::INTER_AREA);
  return out;
}

FloatImage ScaledDown(const FloatImage& image, int width, int height) {
  StayOnThisThread();
  FloatImage out(width, height);
  cv::Mat scaled = View(out);
  cv::resize(View(image), scaled, scaled.size(), 0, 0, cv::INTER_AREA);
  return out;
}

fsm::Image Cropped(const fsm::Image& image, int left, int top, int width, int height) {
  fsm::Image out = fsm::FilledImage(width, height);
  cv::Mat part = View(out);
  View(image)(cv::Rect(left, top, width, height)).copyTo(part);
  return out;
}

fsm::Image Turned(const fsm::Image& image, int orientation) {
  const bool swaps = orientation >= 5;
  fsm::Image out =
      fsm::FilledImage(swaps ? image.height : image.width, swaps ? image.width : image.height);
  cv::Mat turned = View(out);
  swaps ? cv::transpose(View(image), turned) : View(image).copyTo(turned);
  // 2, 3, 7 and 8 run from right to left, 3, 4, 6 and 7 from below; for 5 to 8 as transposed.
  const bool across = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
  const bool down = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
  if (across) cv::flip(turned, turned, 1);
  if (down) cv::flip(turned, turned, 0);
  return out;
}

}  // namespace facefit
