#include "fsm/image/shrink.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace fsm {
namespace {

/// The source pixels along one side, from `first` on, and their weights in one target pixel.
struct Taps {
  int first;
  std::vector<float> weights;
};

std::vector<Taps> TapsOf(int old_size, int new_size) {
  const float ratio = static_cast<float>(old_size) / static_cast<float>(new_size);
  std::vector<Taps> all;
  for (int i = 0; i < new_size; ++i) {
    const float from = static_cast<float>(i) * ratio, to = from + ratio;
    Taps taps{static_cast<int>(from), {}};
    const int last = std::min(static_cast<int>(std::ceil(to)), old_size);
    for (int k = taps.first; k < last; ++k) {
      const float begin = static_cast<float>(k);
      taps.weights.push_back((std::min(to, begin + 1) - std::max(from, begin)) / ratio);
    }
    all.push_back(std::move(taps));
  }
  return all;
}

}  // namespace

Image Shrunk(const Image& image, int width, int height) {
  assert(width > 0 && width <= image.width && height > 0 && height <= image.height);
  const std::vector<Taps> across = TapsOf(image.width, width), down = TapsOf(image.height, height);
  const auto row = static_cast<std::size_t>(image.width) * 4;
  std::vector<float> sums(row);
  Image out{width, height, {}};
  out.rgba.reserve(4 * out.Index(0, height));
  for (const Taps& rows : down) {
    std::ranges::fill(sums, 0.0f);
    const std::uint8_t* from = image.rgba.data() + static_cast<std::size_t>(rows.first) * row;
    for (const float weight : rows.weights) {
      for (std::size_t i = 0; i < row; ++i) sums[i] += weight * static_cast<float>(from[i]);
      from += row;
    }
    for (const Taps& columns : across) {
      const float* at = sums.data() + static_cast<std::size_t>(columns.first) * 4;
      float mean[4] = {0.5f, 0.5f, 0.5f, 0.5f};
      for (const float weight : columns.weights) {
        for (float& channel : mean) channel += weight * *at++;
      }
      for (const float channel : mean) {
        out.rgba.push_back(static_cast<std::uint8_t>(std::min(channel, 255.0f)));
      }
    }
  }
  return out;
}

Image Halved(const Image& image) {
  Image half{std::max(image.width / 2, 1), std::max(image.height / 2, 1), {}};
  half.rgba.reserve(4 * half.Index(0, half.height));
  for (int y = 0; y < half.height; ++y) {
    const std::uint8_t* above = &image.rgba[4 * image.Index(0, 2 * y)];
    const std::uint8_t* below =
        &image.rgba[4 * image.Index(0, std::min(2 * y + 1, image.height - 1))];
    for (int x = 0; x < half.width; ++x) {
      const int left = 8 * x, right = 4 * std::min(2 * x + 1, image.width - 1);
      for (int c = 0; c < 4; ++c) {
        const int sum = above[left + c] + above[right + c] + below[left + c] + below[right + c];
        half.rgba.push_back(static_cast<std::uint8_t>((sum + 2) / 4));
      }
    }
  }
  return half;
}

void HalveUntil(Image& image, int side) {
  while (image.width > side || image.height > side) image = Halved(image);
}

}  // namespace fsm
