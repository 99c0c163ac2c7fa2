#include "fsm/mesh/picture_sheet.h"

#include <algorithm>
#include <utility>

namespace fsm {
namespace {

Image Halved(const Image& image) {
  Image half;
  half.width = std::max(image.width / 2, 1);
  half.height = std::max(image.height / 2, 1);
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      for (int c = 0; c < 4; ++c) {
        int sum = 0;
        for (int k = 0; k < 4; ++k) {
          const int px = std::min(2 * x + (k & 1), image.width - 1);
          const int py = std::min(2 * y + (k >> 1), image.height - 1);
          sum += image.rgba[static_cast<std::size_t>(4 * (py * image.width + px) + c)];
        }
        half.rgba.push_back(static_cast<std::uint8_t>((sum + 2) / 4));
      }
    }
  }
  return half;
}

}  // namespace

void Shrink(Image& picture, int side) {
  while (picture.width > side || picture.height > side) picture = Halved(picture);
}

std::size_t PictureSheet::Add(Image picture) {
  Shrink(picture, kMaxSide);
  pictures_.push_back(std::move(picture));
  return pictures_.size() - 1;
}

std::shared_ptr<const WornPhoto> PictureSheet::Make() {
  if (pictures_.empty()) return nullptr;
  // In rows, each as high as its highest picture; a rim of repeated edge pixels around each keeps
  // filtering from mixing neighbours.
  constexpr int kRim = 2;
  struct Spot {
    int x, y;
  };
  std::vector<Spot> spots;
  int width = 0, height = 0;
  for (;;) {
    spots.clear();
    width = height = 0;
    int x = 0, row = 0;
    for (const Image& picture : pictures_) {
      const int w = picture.width + 2 * kRim;
      if (x > 0 && x + w > 2 * kMaxSide + 4 * kRim) {
        height += row;
        x = row = 0;
      }
      spots.push_back({x + kRim, height + kRim});
      x += w;
      row = std::max(row, picture.height + 2 * kRim);
      width = std::max(width, x);
    }
    height += row;
    if (height <= kMaxSheet) break;
    for (Image& picture : pictures_) picture = Halved(picture);
  }
  WornPhoto sheet{width, height, {}};
  sheet.rgba.assign(static_cast<std::size_t>(4) * static_cast<std::size_t>(width) *
                        static_cast<std::size_t>(height),
                    255);
  places_.clear();
  for (std::size_t i = 0; i < pictures_.size(); ++i) {
    const Image& picture = pictures_[i];
    for (int y = -kRim; y < picture.height + kRim; ++y) {
      for (int x = -kRim; x < picture.width + kRim; ++x) {
        const int sx = std::clamp(x, 0, picture.width - 1);
        const int sy = std::clamp(y, 0, picture.height - 1);
        const auto from = static_cast<std::size_t>(4) *
                          (static_cast<std::size_t>(sy) * static_cast<std::size_t>(picture.width) +
                           static_cast<std::size_t>(sx));
        const auto to = static_cast<std::size_t>(4) * (static_cast<std::size_t>(spots[i].y + y) *
                                                           static_cast<std::size_t>(width) +
                                                       static_cast<std::size_t>(spots[i].x + x));
        std::copy_n(&picture.rgba[from], 4, &sheet.rgba[to]);
      }
    }
    const glm::vec2 size(width, height);
    places_.push_back({glm::vec2(spots[i].x, spots[i].y) / size,
                       glm::vec2(spots[i].x + picture.width, spots[i].y + picture.height) / size});
  }
  return std::make_shared<WornPhoto>(std::move(sheet));
}

}  // namespace fsm
