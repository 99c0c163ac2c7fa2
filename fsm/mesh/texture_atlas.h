#pragma once

#include <glm/gtc/type_precision.hpp>
#include <glm/vec2.hpp>
#include <memory>
#include <vector>

#include "fsm/image/image.h"
#include "fsm/rig/head.h"

namespace fsm {

/// Halves a picture until neither side is longer than `side`.
void Shrink(Image& picture, int side);

/// Puts several pictures into one, because a head wears one photo.
class TextureAtlas {
 public:
  static constexpr int kMaxSide = 2048;  ///< of one picture
  /// Where a picture lies on the sheet: its corners, 0..1, v down.
  struct Place {
    glm::vec2 low{0}, high{1};
    glm::vec2 At(glm::vec2 uv) const { return low + uv * (high - low); }
  };
  /// The number of the picture, for place(). Pictures beyond kMaxSide are halved until they fit.
  std::size_t Add(Image picture);
  /// Lays all out. Nothing if there are none.
  std::shared_ptr<const Image> Make();
  /// Others laid out alike, half as large; `neutral` where one is missing or empty. Nothing if all
  /// are. REQUIRES: Make was called.
  std::shared_ptr<const Image> MakeBeside(std::vector<Image> others, glm::u8vec4 neutral) const;
  /// Valid after Make.
  const Place& place(std::size_t picture) const { return places_[picture]; }

 private:
  static constexpr int kMaxSheet = 8192;  ///< of the sheet
  struct Spot {
    int x, y;
  };
  static constexpr int kRim = 2;
  std::vector<Image> pictures_;
  std::vector<Spot> spots_;
  std::vector<Place> places_;
  int width_ = 0, height_ = 0;
};

}  // namespace fsm
