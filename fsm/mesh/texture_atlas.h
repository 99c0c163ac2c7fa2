#pragma once

#include <glm/gtc/type_precision.hpp>
#include <glm/vec2.hpp>
#include <memory>
#include <vector>

#include "fsm/image/image.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Packs several pictures into one, because a head has one texture.
class TextureAtlas {
 public:
  static constexpr int kMaxSide = 2048;  ///< of a picture, in pixels
  /// The rectangle of a picture in the atlas: its corners, 0..1, v down.
  struct Rect {
    glm::vec2 low{0}, high{1};
    glm::vec2 At(glm::vec2 uv) const { return low + uv * (high - low); }
  };
  /// Takes a picture, halved until neither side is above kMaxSide. Returns its number for rect().
  std::size_t Add(Image picture);
  /// Lays all pictures out on one. Returns nullptr if there are none.
  std::shared_ptr<const Image> Make();
  /// Makes a second atlas of other pictures, at half the size and with the same layout: `others[i]`
  /// has the rectangle of picture i. Where one is missing or empty the atlas has the colour
  /// `neutral`. Returns nullptr if all are missing or empty. REQUIRES: Make was called.
  std::shared_ptr<const Image> MakeBeside(std::vector<Image> others,
                                          std::array<std::uint8_t, 4> neutral) const;
  /// Valid after Make.
  const Rect& rect(std::size_t picture) const { return rects_[picture]; }

 private:
  static constexpr int kMaxAtlas = 8192;  ///< of the atlas, in pixels
  struct Spot {
    int x, y;
  };
  static constexpr int kRim = 2;
  std::vector<Image> pictures_;
  std::vector<Spot> spots_;
  std::vector<Rect> rects_;
  int width_ = 0, height_ = 0;
};

}  // namespace fsm
