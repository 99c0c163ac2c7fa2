#include "fsm/film/yuv_planes.h"

#include <algorithm>

namespace fsm {
namespace {

struct Rgb {
  int r, g, b;
};

Rgb OnBlack(const std::uint8_t* pixel) {
  const int a = pixel[3];
  if (a == 255) return {pixel[0], pixel[1], pixel[2]};
  const auto part = [a](int c) { return (c * a + 127) / 255; };
  return {part(pixel[0]), part(pixel[1]), part(pixel[2])};
}

// ITU-R BT.709-6, item 3.2 to 3.4 (Kr 0.2126, Kb 0.0722), times 219/255 or 224/255, times 2^16.
constexpr int kHalf = 1 << 15;

std::uint8_t Luma(const Rgb& c) {
  return static_cast<std::uint8_t>(16 + ((11966 * c.r + 40254 * c.g + 4064 * c.b + kHalf) >> 16));
}

/// Returns Cb of four pixels from the sum of their colours.
std::uint8_t BlueDifference(const Rgb& sum) {
  return static_cast<std::uint8_t>(
      128 + ((-6596 * sum.r - 22188 * sum.g + 28784 * sum.b + 2 * kHalf * 2) >> 18));
}

std::uint8_t RedDifference(const Rgb& sum) {
  return static_cast<std::uint8_t>(
      128 + ((28784 * sum.r - 26145 * sum.g - 2639 * sum.b + 2 * kHalf * 2) >> 18));
}

}  // namespace

void YuvPlanes(const Image& picture, std::vector<std::uint8_t>& out) {
  const auto width = static_cast<std::size_t>(picture.width);
  const auto height = static_cast<std::size_t>(picture.height);
  const std::size_t even_width = width + width % 2;
  const std::size_t even_height = height + height % 2;
  out.resize(even_width * even_height * 3 / 2);
  std::uint8_t* blue = out.data() + even_width * even_height;
  std::uint8_t* red = blue + even_width * even_height / 4;
  for (std::size_t y = 0; y < even_height; y += 2) {
    const std::uint8_t* rows[] = {&picture.rgba[y * width * 4],
                                  &picture.rgba[std::min(y + 1, height - 1) * width * 4]};
    std::uint8_t* luma[] = {&out[y * even_width], &out[(y + 1) * even_width]};
    for (std::size_t x = 0; x < even_width; x += 2) {
      const std::size_t next = std::min(x + 1, width - 1);
      Rgb sum{};
      for (int k = 0; k < 2; ++k) {
        const Rgb left = OnBlack(rows[k] + 4 * x);
        const Rgb right = OnBlack(rows[k] + 4 * next);
        luma[k][x] = Luma(left);
        luma[k][x + 1] = Luma(right);
        sum = {sum.r + left.r + right.r, sum.g + left.g + right.g, sum.b + left.b + right.b};
      }
      *blue++ = BlueDifference(sum);
      *red++ = RedDifference(sum);
    }
  }
}

}  // namespace fsm
