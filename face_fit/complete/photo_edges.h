#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "face_fit/complete/canvas.h"
#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// What the edge of a photo cuts; a tip is one of a collar, beside a neck.
enum class EdgeKind { kNothing, kSkin, kHair, kCloth, kTip };

/// What a photo shows of its figure at one pixel of an edge.
struct EdgeSample {
  glm::vec3 colour{0};  ///< 0..255
  float opacity = 0;    ///< of the figure, 0..1
  EdgeKind kind = EdgeKind::kNothing;
};
/// At an edge beyond which hair is mirrored.
struct EdgeSampleWithHair : EdgeSample {
  int hair_depth_px = 0;  ///< so far inward no skin is seen
};

/// What the edges of a photo show of its figure, column by column and row by row.
class PhotoEdges {
 public:
  /// `skin`: 0..255. REQUIRES: `figure` has a pixel.
  PhotoEdges(const FittedHead& fitted, const FigureCutout& figure, glm::vec3 skin);

  int width() const { return static_cast<int>(bottom_.size()); }
  int height() const { return static_cast<int>(aside_.left.size()); }
  const EdgeSample& bottom(int x) const { return bottom_[static_cast<std::size_t>(x)]; }
  const EdgeSampleWithHair& top(int x) const { return top_[static_cast<std::size_t>(x)]; }
  const EdgeSampleWithHair& aside(PhotoEdge edge, int y) const {
    return aside_[edge][static_cast<std::size_t>(y)];
  }
  /// How high what the upper edge cuts is rounded off, by the width that it cuts: least and most.
  glm::vec2 DomeByWidth() const;
  /// The mean colour of what is head, but no skin: hair or a hat.
  glm::vec3 hair() const { return hair_; }

 private:
  std::vector<EdgeSample> bottom_;
  std::vector<EdgeSampleWithHair> top_;
  PerEdge<std::vector<EdgeSampleWithHair>> aside_;
  glm::vec3 hair_;
};

}  // namespace facefit
