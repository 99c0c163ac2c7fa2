#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "face_fit/complete/body_shape.h"
#include "face_fit/complete/canvas.h"
#include "face_fit/complete/edge_means.h"
#include "face_fit/complete/photo_edges.h"
#include "fsm/head/face_light.h"

namespace facefit {

/// Paints the body (BodyShape) beyond a photo, in the colours found along the photo's edge and lit
/// by the photo's light.
class BodyPaint {
 public:
  /// The references must outlive this object.
  BodyPaint(const Canvas& canvas, const PhotoEdges& edges, const fsm::FaceLight& light,
            const BodyShape& shape);
  /// REQUIRES: the pixel lies beyond the photo.
  Paint PaintAt(glm::vec2 pixel) const;

 private:
  /// What covers the body; also the index into Differences.
  enum Covering { kSkin, kCloth };
  /// Along one edge, by Covering: the photo's colour less that of the drawn bust, 0..255.
  using Differences = std::array<EdgeMeans, 2>;
  /// The skin that the lower edge cuts, pixels.
  struct Neckline {
    float middle, half_width;
  };

  static Neckline FindNeckline(const PhotoEdges& edges, float axis);
  void AddDifference(const EdgeSample& edge, glm::vec2 pixel, Differences& to) const;
  glm::vec3 BustColour(const BustSample& body, Covering covering) const;
  float ClothShare(glm::vec2 pixel, const DistanceOutside& outside, float on_bust) const;
  glm::vec3 EdgeDifference(glm::vec2 pixel, const DistanceOutside& outside,
                           Covering covering) const;

  const Canvas& canvas_;
  const fsm::FaceLight& light_;
  const BodyShape& shape_;
  glm::vec3 cloth_colour_;  ///< 0..255
  Neckline neckline_;
  Differences below_;
  PerPhotoEdge<Differences> beside_;
};

}  // namespace facefit
