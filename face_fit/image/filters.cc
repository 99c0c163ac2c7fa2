#include "face_fit/image/filters.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec4.hpp>
#include <opencv2/imgproc.hpp>

#include "face_fit/image/pixels.h"
#include "fsm/image/shrink.h"

namespace facefit {
namespace {

/// Keeps OpenCV from starting threads of its own.
void StayOnThisThread() {
  static const bool done = (cv::setNumThreads(1), true);
  (void)done;
}

/// Returns a view of an image, which must outlive it; every filter goes through these. OpenCV does
/// not write into views of const images.
template <typename T>
cv::Mat View(const Raster<T>& image) {
  StayOnThisThread();
  constexpr int kChannels = sizeof(T) / sizeof(float);
  return {image.height, image.width, CV_32FC(kChannels), const_cast<T*>(image.values.data())};
}
cv::Mat View(const fsm::Image& image) {
  StayOnThisThread();
  return {image.height, image.width, CV_8UC4, const_cast<std::uint8_t*>(image.rgba.data())};
}

}  // namespace

template <typename T>
Raster<T> Blurred(const Raster<T>& image, int reach) {
  Raster<T> out(image.width, image.height);
  cv::Mat sums = View(out);
  const int square = 2 * reach + 1;
  cv::boxFilter(View(image), sums, CV_32F, {square, square}, {-1, -1}, false, cv::BORDER_CONSTANT);
  const auto within = [reach](int i, int size) {
    return static_cast<float>(std::min(i + reach, size - 1) - std::max(i - reach, 0) + 1);
  };
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) out(x, y) /= within(x, out.width) * within(y, out.height);
  }
  return out;
}
template FloatImage Blurred(const FloatImage& image, int reach);
template VectorImage Blurred(const VectorImage& image, int reach);
template Raster<glm::mat3> Blurred(const Raster<glm::mat3>& image, int reach);

VectorImage Closed(const VectorImage& image, int reach) {
  VectorImage out(image.width, image.height);
  cv::Mat closed = View(out);
  const int square = 2 * reach + 1;
  cv::morphologyEx(View(image), closed, cv::MORPH_CLOSE,
                   cv::getStructuringElement(cv::MORPH_RECT, {square, square}));
  return out;
}

void PushPullInpaint(fsm::Image& image, const Mask& weight) {
  StayOnThisThread();
  using Pixel = cv::Vec4f;  // colour times weight, weight
  std::vector<cv::Mat_<Pixel>> levels(1, cv::Mat_<Pixel>(image.height, image.width));
  std::size_t i = 0;
  for (Pixel& p : levels[0]) {
    const glm::vec4 weighted = glm::vec4(Rgb(image, i), 1) * weight[i];
    p = {weighted.r, weighted.g, weighted.b, weighted.w};
    ++i;
  }
  // Push: each pixel is the sum of four finer ones, scaled down to a weight of at most 1.
  while (levels.back().total() > 1) {
    cv::Mat_<Pixel> even, coarse;
    cv::copyMakeBorder(levels.back(), even, 0, levels.back().rows % 2, 0, levels.back().cols % 2,
                       cv::BORDER_CONSTANT, cv::Scalar::all(0));
    cv::resize(even, coarse, even.size() / 2, 0, 0, cv::INTER_AREA);
    for (Pixel& mean : coarse) mean *= 1 / std::max(mean[3], 0.25F);
    levels.push_back(coarse);
  }
  // Pull: what a pixel's weight lacks of 1 comes from the coarser level.
  for (std::size_t l = levels.size() - 1; l-- > 0;) {
    cv::Mat_<Pixel> from;
    cv::resize(levels[l + 1], from, levels[l + 1].size() * 2, 0, 0, cv::INTER_LINEAR);
    levels[l].forEach([&from](Pixel& here, const int* at) {
      const Pixel& there = from(at[0], at[1]);
      if (here[3] < 1 && there[3] > 0) here += there * ((1 - here[3]) / there[3]);
    });
  }
  i = 0;
  for (const Pixel& p : levels[0]) {
    SetRgb(image, i++, glm::vec3(p[0], p[1], p[2]) / std::max(p[3], 1e-3F));
  }
}

void FillHoles(Mask& image) {
  // A border of one pixel connects everything outside.
  cv::Mat covered;
  cv::copyMakeBorder(View(image) > 0, covered, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  constexpr int kOutside = 128;
  cv::floodFill(covered, {0, 0}, cv::Scalar(kOutside));
  image = Mask::From(image.width, image.height, [&](int x, int y) {
    return covered.at<std::uint8_t>(y + 1, x + 1) == kOutside ? 0.0F : 1.0F;
  });
}

void KeepConnected(glm::ivec2 to, Mask& image) {
  constexpr float kMin = 0.1F;
  const glm::ivec2 seed = glm::clamp(to, glm::ivec2(0), glm::ivec2(image.width, image.height) - 1);
  if (image(seed.x, seed.y) < kMin) return;
  cv::Mat present = View(image) >= kMin;  // 255 where it is
  constexpr int kKept = 128;
  cv::floodFill(present, {seed.x, seed.y}, cv::Scalar(kKept), nullptr, {}, {}, 8);
  ForEachPixel(image.width, image.height, [&](int x, int y, std::size_t i) {
    if (present.at<std::uint8_t>(y, x) != kKept) image[i] = 0;
  });
}

std::vector<std::size_t> NearestAbove(const FloatImage& image, float threshold) {
  assert(std::ranges::any_of(image.values, [=](float value) { return value >= threshold; }));
  cv::Mat distance, label;
  const cv::Mat unknown = View(image) < threshold;
  cv::distanceTransform(unknown, distance, label, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  std::vector<std::size_t> of_label(image.size() + 1), nearest(image.size());
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (image[i] >= threshold)
      of_label[static_cast<std::size_t>(label.begin<int>()[static_cast<int>(i)])] = i;
  }
  std::ranges::transform(std::span(label.ptr<int>(), nearest.size()), nearest.begin(),
                         [&](int k) { return of_label[static_cast<std::size_t>(k)]; });
  return nearest;
}

float SignedDistance(std::span<const glm::vec2> outline, glm::vec2 pixel) {
  const cv::Mat line(static_cast<int>(outline.size()), 1, CV_32FC2,
                     const_cast<glm::vec2*>(outline.data()));
  return static_cast<float>(-cv::pointPolygonTest(line, {pixel.x, pixel.y}, true));
}

fsm::Image ScaledToFit(fsm::Image image, int most_size) {
  const int longer = std::max(image.width, image.height);
  if (longer <= most_size) return image;
  const auto scaled = [&](int side) {
    return std::max(static_cast<int>(std::lround(static_cast<double>(side) * most_size / longer)),
                    1);
  };
  return fsm::Shrunk(image, scaled(image.width), scaled(image.height));
}

template <typename T>
Raster<T> ScaledDown(const Raster<T>& image, int width, int height) {
  assert(width >= 1 && width <= image.width && height >= 1 && height <= image.height);
  Raster<T> out(width, height);
  cv::Mat scaled = View(out);
  cv::resize(View(image), scaled, scaled.size(), 0, 0, cv::INTER_AREA);
  return out;
}
template FloatImage ScaledDown(const FloatImage& image, int width, int height);
template VectorImage ScaledDown(const VectorImage& image, int width, int height);

fsm::Image Cropped(const fsm::Image& image, int left, int top, int width, int height) {
  assert(left >= 0 && width >= 1 && left + width <= image.width);
  assert(top >= 0 && height >= 1 && top + height <= image.height);
  fsm::Image out = fsm::FilledImage(width, height);
  cv::Mat cropped = View(out);
  View(image)(cv::Rect(left, top, width, height)).copyTo(cropped);
  return out;
}

fsm::Image OrientedByExif(const fsm::Image& image, int orientation) {
  const bool swaps = orientation >= 5;
  fsm::Image out =
      fsm::FilledImage(swaps ? image.height : image.width, swaps ? image.width : image.height);
  cv::Mat turned = View(out);
  if (swaps) {
    cv::transpose(View(image), turned);
  } else {
    View(image).copyTo(turned);
  }
  // After 5 to 8 are transposed, 2, 3, 6 and 7 are mirrored sideways, 3, 4, 7 and 8 upside down.
  const bool across = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
  const bool down = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
  if (across) cv::flip(turned, turned, 1);
  if (down) cv::flip(turned, turned, 0);
  return out;
}

}  // namespace facefit
