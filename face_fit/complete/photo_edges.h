#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "face_fit/complete/canvas.h"
#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// What the edge of a photo cuts. kTip: the tip of a collar beside a bare neck.
enum class EdgeKind { kNothing, kSkin, kHair, kCloth, kTip };

/// The figure at one pixel of an edge, averaged over edge.band_mm inward.
struct EdgeSample {
  glm::vec3 colour{0};  ///< 0..255
  float opacity = 0;    ///< of the figure, 0..1
  EdgeKind kind = EdgeKind::kNothing;
  /// Top and sides, beyond which hair is continued as a mirror image: length of the run inward from
  /// the edge without skin or background.
  int hair_reach_px = 0;
};

/// Classifies the figure along the edges of a photo: lower and upper edge column by column, left
/// and right edge row by row.
class PhotoEdges {
 public:
  /// `skin_colour`: of the face, 0..255. REQUIRES: `figure` has a pixel.
  PhotoEdges(const FittedHead& fitted, const FigureCutout& figure, glm::vec3 skin_colour);

  int width() const { return static_cast<int>(bottom_.size()); }
  int height() const { return static_cast<int>(sides_.left.size()); }
  const EdgeSample& bottom(int x) const { return bottom_[static_cast<std::size_t>(x)]; }
  const EdgeSample& top(int x) const { return top_[static_cast<std::size_t>(x)]; }
  const EdgeSample& side(PhotoEdge side, int y) const {
    return sides_[side][static_cast<std::size_t>(y)];
  }
  /// Returns whether the figure touches the upper edge from corner to corner.
  bool TopCutsWholeEdge() const;
  /// Returns the mean colour of hair or hat, 0..255.
  glm::vec3 hair() const { return hair_; }

 private:
  std::vector<EdgeSample> bottom_;
  std::vector<EdgeSample> top_;
  PerPhotoEdge<std::vector<EdgeSample>> sides_;
  glm::vec3 hair_;
};

}  // namespace facefit
