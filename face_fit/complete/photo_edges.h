#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "face_fit/complete/canvas.h"
#include "face_fit/find/figure/matte.h"
#include "face_fit/find/head/base_head.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// What the edge of a photo cuts; a tip is one of a collar, beside a neck.
enum class EdgeKind { kNothing, kSkin, kHair, kCloth, kTip };

/// What the edges of a photo show of its figure, column by column and row by row.
class PhotoEdges {
 public:
  struct Seen {
    glm::vec3 colour{0};  ///< 0..255
    float opacity = 0;    ///< of the figure, 0..1
    EdgeKind kind = EdgeKind::kNothing;
    int hair_depth = 0;  ///< how many pixels inward no skin is seen; not told of the bottom
  };
  /// `skin`: 0..255. REQUIRES: `figure` has a pixel.
  PhotoEdges(const FittedHead& fitted, const Cutout& figure, glm::vec3 skin);

  int width() const { return static_cast<int>(bottom_.size()); }
  int height() const { return static_cast<int>(aside_.left.size()); }
  const Seen& bottom(int x) const { return bottom_[static_cast<std::size_t>(x)]; }
  const Seen& top(int x) const { return top_[static_cast<std::size_t>(x)]; }
  const Seen& aside(PhotoEdge edge, int y) const {
    return aside_[edge][static_cast<std::size_t>(y)];
  }
  /// The mean colour of what is head, but no skin: hair or a hat.
  glm::vec3 hair() const { return hair_; }

 private:
  glm::vec3 HairBeside(float chin, glm::vec3 skin) const;
  void ClassifyNeck(const Cutout& figure, glm::vec2 chin, float per_mm);

  std::vector<Seen> bottom_, top_;
  PerEdge<std::vector<Seen>> aside_;
  glm::vec3 hair_{0};
};

}  // namespace facefit
