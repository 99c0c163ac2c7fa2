#pragma once

#include <optional>
#include <vector>

#include "fsm/image/image.h"
#include "hypermask/geometry/plane_map.h"

namespace hypermask {

/// Dots in rows and columns over the projector's picture, each of which tells by going on and off
/// which one it is: so it does not matter how many of them fall on the mask. The frames: dark, all
/// dots, a frame for each bit of a dot's number, one that makes their count even, dark again.
class DotPattern {
 public:
  static constexpr int kSpacing = 26, kRadius = 5;  ///< projector's pixels

  DotPattern(int width, int height);
  std::size_t frames() const { return 4 + bits_; }
  fsm::Image Frame(std::size_t frame) const;
  /// The place, in the projector's pixels, of the dot that was lit so in frames 2 and later, but
  /// for the last; nothing if there is none.
  std::optional<Point> Decode(const std::vector<bool>& lit) const;

 private:
  std::size_t dots() const { return columns_ * rows_; }
  Point PlaceOf(std::size_t dot) const;
  bool Lit(std::size_t dot, std::size_t frame) const;
  int width_, height_;
  std::size_t columns_, rows_, bits_;
};

}  // namespace hypermask
