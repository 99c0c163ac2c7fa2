#pragma once

#include <glm/vec2.hpp>

#include "face_fit/complete/canvas.h"
#include "face_fit/complete/edge_means.h"
#include "face_fit/complete/photo_edges.h"

namespace facefit {

/// Returns the height above a photo of the dome of hair that its upper edge cuts over `width_px`,
/// pixels. `crown_px`: row of the top of the skull with its hair, photo pixels.
float DomeHeightPx(const PhotoEdges& edges, float width_px, float crown_px);

/// Paints hair (or a hat) beyond a photo that cuts it; canvas.h has a drawing of the regions. Above
/// the head it is rounded off, beside the head it bulges a little; both show the mirror image of
/// the hair within, or the mean colour of the hair where skin reaches the edge. Hair at the lower
/// edge hangs on in the colours of that edge and ends in strands.
class HairPaint {
 public:
  /// `colours`: of the figure; `crown_px`: as for DomeHeightPx. The references must outlive this
  /// object.
  HairPaint(const Canvas& canvas, const PhotoEdges& edges, const fsm::Image& colours,
            float crown_px);
  /// Returns whether the photo cuts hair above, on the left or on the right.
  bool CutsHair() const { return cut_; }
  /// Returns the hair's colour and opacity at a pixel. REQUIRES: it lies beyond the photo.
  Paint PaintAt(glm::vec2 pixel) const;

 private:
  float DomePx(float x) const;
  float BulgePx(PhotoEdge side, float y) const;
  glm::vec3 Colour(glm::vec2 pixel) const;
  Paint HairBelow(glm::vec2 pixel, float below_px) const;

  /// A run of an edge along which it cuts the hair, pixels.
  struct EdgeSpan {
    float from = 0, to = 0;
    float Length() const { return to - from; }
  };
  /// Returns the longest run of samples of an edge for which `cuts_head(i)` is true.
  static EdgeSpan LongestRun(int count, auto cuts_head);
  EdgeSpan SpanOf(PhotoEdge side) const;

  const Canvas& canvas_;
  const PhotoEdges& edges_;
  const fsm::Image& colours_;
  EdgeSpan top_;
  PerPhotoEdge<EdgeSpan> sides_;
  float dome_px_ = 0;             ///< height of the dome above the photo, pixels
  PerPhotoEdge<float> bulge_px_;  ///< width of the bulge beside the photo, pixels
  EdgeMeans below_;               ///< the hair's colours along the lower edge
  bool bearded_ = false, cut_ = false;
};

}  // namespace facefit
