#pragma once

#include <glm/vec2.hpp>

#include "face_fit/complete/canvas.h"
#include "face_fit/complete/edge_means.h"
#include "face_fit/complete/photo_edges.h"

namespace facefit {

/// Hair (or a hat) beyond a photo that cuts it: above the head it is rounded off, beside the head
/// it goes on a little, both as a mirror image of the hair within, or in the hair's usual colour
/// where skin reaches the edge; what the lower edge cuts falls on in the colours of that edge and
/// ends in strands.
class HairPaint {
 public:
  /// `crown`: the row of the top of the skull with its hair. The references outlive this.
  HairPaint(const Canvas& canvas, const PhotoEdges& edges, const FigureCutout& figure, float crown);
  /// Whether the photo cuts hair above or aside.
  bool Cut() const { return cut_; }
  /// REQUIRES: beyond the photo.
  Paint PaintAt(glm::vec2 place) const;

 private:
  float DomeHeight(float x) const;
  float BulgeWidth(PhotoEdge edge, float y) const;
  glm::vec3 Colour(glm::vec2 place) const;
  Paint HairBelow(glm::vec2 place, float below_px) const;

  /// A part of an edge that cuts the hair, pixels.
  struct EdgeSpan {
    float from = 0, to = 0;
    float Length() const { return to - from; }
  };
  EdgeSpan TopSpan() const;
  EdgeSpan SpanAside(PhotoEdge edge) const;

  const Canvas& canvas_;
  const PhotoEdges& edges_;
  const FigureCutout& figure_;
  EdgeSpan top_;
  PerEdge<EdgeSpan> aside_;
  float dome_ = 0;        ///< how high the top is rounded off, pixels
  PerEdge<float> bulge_;  ///< how far it goes on beside, pixels
  EdgeMeans below_;       ///< the hair along the lower edge
  bool bearded_ = false, cut_ = false;
};

}  // namespace facefit
