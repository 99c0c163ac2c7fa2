#include "fsm/mesh/texture_atlas.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

#include "fsm/image/shrink.h"

namespace fsm {
namespace {

/// Copies a picture into the atlas, scaled to the given size, with its edge pixels repeated around
/// it.
void Lay(const Image& picture, glm::ivec2 at, glm::ivec2 size, int rim, Image& atlas) {
  for (int y = -rim; y < size.y + rim; ++y) {
    const int to_y = at.y + y;
    const int from_y = std::clamp(y, 0, size.y - 1) * picture.height / size.y;
    for (int x = -rim; x < size.x + rim; ++x) {
      const int to_x = at.x + x;
      if (to_x < 0 || to_y < 0 || to_x >= atlas.width || to_y >= atlas.height) continue;
      const int from_x = std::clamp(x, 0, size.x - 1) * picture.width / size.x;
      std::copy_n(&picture.rgba[4 * picture.Index(from_x, from_y)], 4,
                  &atlas.rgba[4 * atlas.Index(to_x, to_y)]);
    }
  }
}

}  // namespace

std::size_t TextureAtlas::Add(Image picture) {
  HalveUntil(picture, kMaxSide);
  pictures_.push_back(std::move(picture));
  return pictures_.size() - 1;
}

std::shared_ptr<const Image> TextureAtlas::Make() {
  if (pictures_.empty()) return nullptr;
  // Pictures are placed in rows, each as high as its highest picture. A rim of repeated edge pixels
  // around each prevents filtering from mixing neighbours.
  for (;;) {
    spots_.clear();
    width_ = height_ = 0;
    int x = 0, row = 0;
    for (const Image& picture : pictures_) {
      const int w = picture.width + 2 * kRim;
      if (x > 0 && x + w > 2 * kMaxSide + 4 * kRim) {
        height_ += row;
        x = row = 0;
      }
      spots_.push_back({x + kRim, height_ + kRim});
      x += w;
      row = std::max(row, picture.height + 2 * kRim);
      width_ = std::max(width_, x);
    }
    height_ += row;
    if (height_ <= kMaxAtlas) break;
    for (Image& picture : pictures_) picture = Halved(picture);
  }
  Image atlas = FilledImage(width_, height_);
  rects_.clear();
  for (std::size_t i = 0; i < pictures_.size(); ++i) {
    const Image& picture = pictures_[i];
    Lay(picture, {spots_[i].x, spots_[i].y}, {picture.width, picture.height}, kRim, atlas);
    const glm::vec2 size(width_, height_);
    rects_.push_back({glm::vec2(spots_[i].x, spots_[i].y) / size,
                      glm::vec2(spots_[i].x + picture.width, spots_[i].y + picture.height) / size});
  }
  return std::make_shared<Image>(std::move(atlas));
}

std::shared_ptr<const Image> TextureAtlas::MakeBeside(std::vector<Image> others,
                                                      std::array<std::uint8_t, 4> neutral) const {
  if (std::ranges::all_of(others, [](const Image& image) { return image.rgba.empty(); })) {
    return nullptr;
  }
  Image atlas = FilledImage((width_ + 1) / 2, (height_ + 1) / 2, neutral);
  for (std::size_t i = 0; i < std::min(others.size(), pictures_.size()); ++i) {
    if (others[i].rgba.empty()) continue;
    const glm::ivec2 size = glm::max(glm::ivec2(pictures_[i].width, pictures_[i].height) / 2, 1);
    while (others[i].width >= 2 * size.x && others[i].height >= 2 * size.y) {
      others[i] = Halved(others[i]);
    }
    Lay(others[i], glm::ivec2(spots_[i].x, spots_[i].y) / 2, size, kRim / 2, atlas);
  }
  return std::make_shared<Image>(std::move(atlas));
}

}  // namespace fsm
