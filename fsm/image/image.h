#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fsm {

/// An 8-bit RGBA picture, row 0 at the top, without padding.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  ///< width * height * 4

  /// Returns the index of a pixel; its bytes begin at four times that index.
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  bool IsWhole() const { return rgba.size() == 4 * Index(0, height); }
};

inline constexpr std::array<std::uint8_t, 4> kBlack = {0, 0, 0, 255};
/// Returns a picture of one colour, by default opaque white.
inline Image FilledImage(int width, int height,
                         std::array<std::uint8_t, 4> colour = {255, 255, 255, 255}) {
  Image image{width, height, {}};
  image.rgba.resize(4 * image.Index(0, height));
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = colour[i % 4];
  return image;
}

/// Longest side of a picture that is read, written or drawn, in pixels.
inline constexpr int kMaxImageSide = 8192;

}  // namespace fsm
