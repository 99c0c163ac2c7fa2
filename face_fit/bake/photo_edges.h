#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "face_fit/find/figure/matte.h"
#include "face_fit/find/head/base_head.h"
#include "face_fit/fit/fitted_head.h"
#include "fsm/head/face_light.h"

namespace facefit {

inline constexpr std::size_t kPhotoSides = 2;  ///< 0 left, 1 right

/// The light that falls on the skin of a face, and the usual colour of that skin.
fsm::FaceLight LightOnFace(const BaseHead& base, const FittedHead& fitted, const Cutout& figure);

/// What the edge of a photo cuts; a tip is one of a collar, beside a neck.
enum class Stuff { kNothing, kSkin, kHair, kCloth, kTip };

/// What the edges of a photo show of its figure, column by column and row by row.
class PhotoEdges {
 public:
  struct Seen {
    glm::vec3 colour{0};  ///< 0..255
    float cover = 0;      ///< of the figure, 0..1
    Stuff stuff = Stuff::kNothing;
  };
  /// `skin`: 0..255. REQUIRES: `figure` has a pixel.
  PhotoEdges(const BaseHead& base, const FittedHead& fitted, const Cutout& figure, glm::vec3 skin);

  int width() const { return static_cast<int>(bottom_.size()); }
  int height() const { return static_cast<int>(aside_[0].size()); }
  const std::vector<Seen>& bottom() const { return bottom_; }  ///< a value for each column
  const std::vector<Seen>& top() const { return top_; }
  const std::vector<Seen>& aside(std::size_t side) const { return aside_[side]; }  ///< for each row
  /// How many pixels no skin is seen inward from the upper edge, and from a side.
  const std::vector<int>& hair_below_top() const { return top_depth_; }
  const std::vector<int>& hair_beside(std::size_t side) const { return aside_depth_[side]; }
  /// The mean colour of what is head, but no skin: hair or a hat.
  glm::vec3 hair() const { return hair_; }

 private:
  glm::vec3 HairBeside(float chin, glm::vec3 skin) const;
  void TellNeck(const Cutout& figure, glm::vec2 chin, float per_mm);

  std::vector<Seen> bottom_, top_;
  std::array<std::vector<Seen>, kPhotoSides> aside_;
  std::vector<int> top_depth_;
  std::array<std::vector<int>, kPhotoSides> aside_depth_;
  glm::vec3 hair_{0};
};

}  // namespace facefit
