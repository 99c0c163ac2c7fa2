#include "hypermask/calibrate/dot_pattern.h"

#include <bit>
#include <cassert>

namespace hypermask {

DotPattern::DotPattern(int width, int height)
    : width_(width),
      height_(height),
      columns_(static_cast<std::size_t>(width / kSpacing)),
      rows_(static_cast<std::size_t>(height / kSpacing)),
      bits_(static_cast<std::size_t>(std::bit_width(columns_ * rows_))) {}

Point DotPattern::PlaceOf(std::size_t dot) const {
  const auto middle = [](std::size_t i) {
    return static_cast<double>(i) * kSpacing + kSpacing / 2;
  };
  return {middle(dot % columns_), middle(dot / columns_)};
}

bool DotPattern::Lit(std::size_t dot, std::size_t frame) const {
  if (frame == 0 || frame + 1 == frames()) return false;
  if (frame == 1) return true;
  // Counted from 1, so that each dot has a bit that is set.
  const std::size_t number = dot + 1, bit = frame - 2;
  if (bit < bits_) return (number >> bit & 1) != 0;
  return std::popcount(number) % 2 != 0;
}

fsm::Image DotPattern::Frame(std::size_t frame) const {
  fsm::Image image = fsm::FilledImage(width_, height_, fsm::kBlack);
  for (std::size_t dot = 0; dot < dots(); ++dot) {
    if (!Lit(dot, frame)) continue;
    const Point place = PlaceOf(dot);
    for (int y = -kRadius; y <= kRadius; ++y) {
      for (int x = -kRadius; x <= kRadius; ++x) {
        if (x * x + y * y > kRadius * kRadius) continue;
        const std::size_t at =
            4 * image.Index(static_cast<int>(place.x()) + x, static_cast<int>(place.y()) + y);
        image.rgba[at] = image.rgba[at + 1] = image.rgba[at + 2] = 255;
      }
    }
  }
  return image;
}

std::optional<Point> DotPattern::Decode(const std::vector<bool>& lit) const {
  assert(lit.size() == bits_ + 1);
  std::size_t number = 0;
  for (std::size_t bit = 0; bit < bits_; ++bit) {
    if (lit[bit]) number |= std::size_t{1} << bit;
  }
  if (number == 0 || number > dots()) return std::nullopt;
  if ((std::popcount(number) % 2 != 0) != lit[bits_]) return std::nullopt;
  return PlaceOf(number - 1);
}

}  // namespace hypermask
