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

/// Neck, shoulders and clothes below a photo and beside it: the bust, made as wide as the figure is
/// where the photo ends, in the colours found along that edge and lit by the photo's light.
class BodyPaint {
 public:
  /// `opacity`: of the figure in the photo; `bust`: drawn on the canvas. All others outlive it.
  BodyPaint(const Canvas& canvas, const PhotoEdges& edges, const FloatImage& opacity,
            const fsm::FaceLight& light, Bust bust);
  /// Whether the left or right edge of the photo cuts the shoulder.
  bool CutsShoulder() const { return joint_.left.cut || joint_.right.cut; }
  /// REQUIRES: beyond the photo, or at its lower edge.
  Paint PaintAt(glm::vec2 place) const;

 private:
  /// What covers the body: the index of what is kept once for each.
  enum Covering { kSkin, kCloth };
  /// The bust at a place; `cloth`: how much of what is covered is cloth.
  struct BustSample {
    float opacity = 0, cloth = 0, openness = 1;
    glm::vec3 normal{0, 0, 1};
  };
  /// Where one half of the figure and that of the bust are made to meet.
  struct Joint {
    float row = 0, width_ratio = 1;  ///< the figure's half width there by the bust's
    float fade_mm = 1;               ///< over how many millimetres downward that fades
    bool cut = false;                ///< by the photo's left or right edge
    float slope = 0;                 ///< if it is: how steeply the outline falls there
  };
  /// Of one edge, by Covering: by how much the photo differs from what is drawn there.
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
  // Each is found by those above it: their order is that of the constructor.
  Bust bust_;
  PerEdge<Joint> joint_;
  glm::vec3 cloth_colour_;  ///< 0..255
  glm::vec2 neckline_;      ///< middle and half width of the skin that the lower edge cuts, pixels
  Differences below_;
  PerEdge<Differences> aside_;
};

}  // namespace facefit
