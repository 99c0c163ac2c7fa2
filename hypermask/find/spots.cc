#include "hypermask/find/spots.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

namespace hypermask {
namespace {

struct Brightness {
  int median = 0, most = 0;
};

Brightness Measure(const Grey& picture) {
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t value : picture.pixels) ++counts[value];
  Brightness found;
  std::size_t below = 0;
  for (std::size_t value = 0; value < counts.size(); ++value) {
    if (counts[value] == 0) continue;
    found.most = static_cast<int>(value);
    if (2 * below < picture.pixels.size()) found.median = static_cast<int>(value);
    below += counts[value];
  }
  return found;
}

}  // namespace

std::vector<Spot> FindSpots(const Grey& picture, const SpotSearch& search) {
  std::vector<Spot> spots;
  if (picture.width < 3 || picture.height < 3) return spots;
  const Brightness brightness = Measure(picture);
  if (brightness.most - brightness.median < search.least_contrast) return spots;
  const double threshold =
      brightness.median + search.threshold * (brightness.most - brightness.median);
  // OpenCV takes no constant memory; it does not write here.
  const cv::Mat grey(picture.height, picture.width, CV_8UC1,
                     const_cast<std::uint8_t*>(picture.pixels.data()));
  cv::Mat bright, labels, stats, middles;
  cv::threshold(grey, bright, threshold, 255, cv::THRESH_BINARY);
  const int count = cv::connectedComponentsWithStats(bright, labels, stats, middles, 8, CV_32S);
  for (int label = 1; label < count; ++label) {
    const int pixels = stats.at<int>(label, cv::CC_STAT_AREA);
    if (pixels < search.least_pixels || pixels > search.most_pixels) continue;
    const int left = stats.at<int>(label, cv::CC_STAT_LEFT);
    const int top = stats.at<int>(label, cv::CC_STAT_TOP);
    const int right = left + stats.at<int>(label, cv::CC_STAT_WIDTH);
    const int bottom = top + stats.at<int>(label, cv::CC_STAT_HEIGHT);
    if (left < 1 || top < 1 || right >= picture.width || bottom >= picture.height) continue;
    // The middle counts the pixels about the spot, too: what is cut off at the threshold would jump
    // from pixel to pixel as the spot moves.
    Spot spot{.pixels = pixels};
    const double floor = brightness.median + 0.15 * (brightness.most - brightness.median);
    for (int y = top - 1; y <= bottom; ++y) {
      for (int x = left - 1; x <= right; ++x) {
        const double weight = picture.pixels[picture.Index(x, y)] - floor;
        if (weight <= 0) continue;
        spot.place += weight * Point(x, y);
        spot.weight += weight;
      }
    }
    if (!(spot.weight > 0)) continue;
    spot.place /= spot.weight;
    spots.push_back(spot);
  }
  const std::size_t keep = std::min(search.most, spots.size());
  std::ranges::partial_sort(spots, spots.begin() + static_cast<std::ptrdiff_t>(keep),
                            [](const Spot& a, const Spot& b) { return a.weight > b.weight; });
  spots.resize(keep);
  return spots;
}

}  // namespace hypermask
