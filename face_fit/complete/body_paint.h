#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "face_fit/complete/bust.h"
#include "face_fit/complete/canvas.h"
#include "face_fit/complete/edge_means.h"
#include "face_fit/complete/photo_edges.h"
#include "fsm/head/face_light.h"

namespace facefit {

/// Paints neck, shoulders and clothes below a photo and beside it: the bust, scaled to the figure's
/// width where the photo ends, in the colours found along the photo's edge, lit by the photo's
/// light. canvas.h has a picture of the regions.
class BodyPaint {
 public:
  /// `opacity`: the figure's, in the photo. `bust`: drawn on the canvas. Others must outlive this.
  BodyPaint(const Canvas& canvas, const PhotoEdges& edges, const FloatImage& opacity,
            const fsm::FaceLight& light, Bust bust);
  /// Returns whether the left or right edge of the photo cuts a shoulder.
  bool CutsShoulder() const { return joint_.left.cut || joint_.right.cut; }
  /// REQUIRES: the place lies beyond the photo, or in it beside the lower edge.
  Paint PaintAt(glm::vec2 place) const;

 private:
  /// What covers the body; also the index into Differences.
  enum Covering { kSkin, kCloth };
  /// The bust at a place. `cloth`: the share of cloth in what is covered, 0..1; `openness`: the
  /// part of the ambient light that arrives, 0..1.
  struct BustSample {
    float opacity = 0, cloth = 0, openness = 1;
    glm::vec3 normal{0, 0, 1};
  };
  /// The row in which one half of the bust meets that half of the figure, and its scale there.
  struct Joint {
    /// Row in photo pixels; half width of the figure divided by that of the bust.
    float row = 0, width_ratio = 1;
    float fade_mm = 1;  ///< distance downward in which the ratio decays to 1 (1/e)
    bool cut = false;   ///< the photo's left or right edge cuts the shoulder
    float slope = 0;    ///< if `cut`: the outline's fall at the edge, pixels down per pixel outward
  };
  /// Along one edge, by Covering: the photo's colour less that of the drawn bust, 0..255.
  using Differences = std::array<EdgeMeans, 2>;

  float Axis() const { return bust_.axis - static_cast<float>(canvas_.photo_origin.x); }
  Joint JointOf(PhotoEdge edge) const;
  float OutlineSlope(PhotoEdge edge, float row) const;
  glm::vec3 ClothColour() const;
  glm::vec2 FindNeckline() const;
  void AddDifference(const EdgeSample& edge, glm::vec2 place, Differences& to) const;
  BustSample SampleAt(glm::vec2 place) const;
  glm::vec3 BustColour(const BustSample& body, Covering covering) const;
  float ClothAt(glm::vec2 place, const Beyond& beyond, float on_bust) const;
  glm::vec3 EdgeDifference(glm::vec2 place, const Beyond& beyond, Covering covering) const;

  const Canvas& canvas_;
  const PhotoEdges& edges_;
  const FloatImage& opacity_;
  const fsm::FaceLight& light_;
  // Each of these is computed from those above it; the constructor initialises them in this order.
  Bust bust_;
  PerEdge<Joint> joint_;
  glm::vec3 cloth_colour_;  ///< 0..255
  /// Middle (x) and half width of the skin that the lower edge cuts, pixels.
  glm::vec2 neckline_;
  Differences below_;
  PerEdge<Differences> aside_;
};

}  // namespace facefit
