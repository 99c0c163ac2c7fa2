#include "face_track/follow/cut_finder.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace facetrack {
namespace {

// Each cell is a mean of many pixels, so that noise does not add up to a cut.
constexpr int kCells = 24, kPixels = 16;  // on a side of a picture, and of a cell
constexpr float kCut = 10;                // of 255, between pictures that follow each other
// What moves within a picture leaves the cells much the same, in other places: so far apart are the
// sorted ones (the earth mover's distance of their histograms).
constexpr float kOtherCells = 5;

std::vector<float> CellsOf(const fsm::Image& picture) {
  constexpr int kSide = kCells * kPixels;
  std::vector<float> cells(kCells * kCells, 0);
  for (int y = 0; y < kSide; ++y) {
    const auto row = static_cast<std::size_t>(y * picture.height / kSide) *
                     static_cast<std::size_t>(picture.width);
    for (int x = 0; x < kSide; ++x) {
      const auto at = 4 * (row + static_cast<std::size_t>(x * picture.width / kSide));
      const int sum = picture.rgba[at] + picture.rgba[at + 1] + picture.rgba[at + 2];
      cells[static_cast<std::size_t>(y / kPixels * kCells + x / kPixels)] +=
          static_cast<float>(sum) / (3 * kPixels * kPixels);
    }
  }
  return cells;
}

float Apart(const std::vector<float>& a, const std::vector<float>& b) {
  float sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / static_cast<float>(a.size());
}

}  // namespace

bool CutFinder::IsCut(const fsm::Image& picture) {
  std::vector<float> cells = CellsOf(picture);
  std::vector<float> before = std::exchange(cells_, cells);
  if (before.empty() || Apart(cells, before) <= kCut) return false;
  std::ranges::sort(cells);
  std::ranges::sort(before);
  return Apart(cells, before) > kOtherCells;
}

}  // namespace facetrack
