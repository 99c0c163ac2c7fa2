#include "film_dub/follow/grain.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace filmdub {
namespace {

cv::Mat GreyOf(const fsm::Image& picture, const cv::Rect& part) {
  const cv::Mat whole(picture.height, picture.width, CV_8UC4,
                      const_cast<std::uint8_t*>(picture.rgba.data()));
  cv::Mat grey, real;
  cv::cvtColor(whole(part), grey, cv::COLOR_RGBA2GRAY);
  grey.convertTo(real, CV_32F, 1.0 / 255);
  return real;
}

}  // namespace

double GrainBetween(const fsm::Image& a, const fsm::Image& b, const facefit::Box2& part) {
  constexpr int kSquare = 8;
  if (part.low.x > part.high.x) return 0;
  const cv::Rect there = cv::Rect(0, 0, a.width, a.height) &
                         cv::Rect(cv::Point(cvRound(part.low.x), cvRound(part.low.y)),
                                  cv::Point(cvRound(part.high.x), cvRound(part.high.y)));
  if (there.empty()) return 0;
  cv::Mat difference;
  cv::subtract(GreyOf(a, there), GreyOf(b, there), difference);
  std::vector<double> deviations;
  for (int y = 0; y + kSquare <= difference.rows; y += kSquare) {
    for (int x = 0; x + kSquare <= difference.cols; x += kSquare) {
      cv::Scalar mean, deviation;
      cv::meanStdDev(difference(cv::Rect(x, y, kSquare, kSquare)), mean, deviation);
      deviations.push_back(deviation[0]);
    }
  }
  if (deviations.empty()) return 0;
  const auto quarter = deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 4);
  std::ranges::nth_element(deviations, quarter);
  return *quarter / std::numbers::sqrt2;
}

}  // namespace filmdub
