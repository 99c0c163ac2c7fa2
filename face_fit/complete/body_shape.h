#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "face_fit/complete/bust.h"
#include "face_fit/complete/canvas.h"
#include "face_fit/complete/photo_edges.h"

namespace facefit {

/// The row of the photo in which one half of the bust meets that half of the figure: where the left
/// or right edge of the photo cuts the shoulder, or else the lower edge.
struct BustAttachment {
  float row = 0;          ///< pixels of the photo
  float width_ratio = 1;  ///< half width of the figure there, divided by that of the bust
  float fade_mm = 1;      ///< distance downward in which the ratio decays to 1 (1/e)
  /// Fall of the shoulder's outline where an edge cuts it, pixels down for each pixel outward;
  /// nothing if no edge does.
  std::optional<float> shoulder_slope;
};

/// The bust at a pixel. `cloth`: the share of cloth in what is covered, 0..1;
/// `ambient_occlusion`: as of Bust.
struct BustSample {
  float opacity = 0, cloth = 0, ambient_occlusion = 1;
  glm::vec3 normal{0, 0, 1};
};

/// Where neck, shoulders and clothes lie below a photo and beside it: the bust, scaled to the
/// figure's width where the photo ends. canvas.h has a drawing of the regions.
class BodyShape {
 public:
  /// `opacity`: the figure's, in the photo. `bust`: drawn on the canvas. `canvas` must outlive
  /// this.
  BodyShape(const Canvas& canvas, const PhotoEdges& edges, const Mask& opacity, Bust bust);

  const PerPhotoEdge<BustAttachment>& attachments() const { return attachments_; }
  /// Returns whether the left or right edge of the photo cuts a shoulder.
  bool CutsShoulder() const {
    return attachments_.left.shoulder_slope || attachments_.right.shoulder_slope;
  }
  float axis() const { return axis_; }  ///< x of the body's middle, pixels of the photo
  BustSample SampleAt(glm::vec2 pixel) const;
  /// Returns how much of a pixel is body, 0..1. `sample`: of that pixel. REQUIRES: it lies beyond
  /// the photo, or in it beside the lower edge.
  float OpacityAt(glm::vec2 pixel, const BustSample& sample) const;

 private:
  const Canvas& canvas_;
  Bust bust_;
  float axis_;
  PerPhotoEdge<BustAttachment> attachments_;
};

}  // namespace facefit
