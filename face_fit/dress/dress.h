#pragma once

#include "face_fit/dress/field.h"
#include "face_fit/find/face_finder.h"
#include "face_fit/fit/fit.h"
#include "face_fit/fit/view.h"
#include "fsm/head/photo_head.h"

namespace facefit {

/// The photo as it is worn: on the skin's map in the left half of one picture, and as the figure
/// with hair, neck and clothes in the right half.
struct TextureBake {
  fsm::Image picture;
  float coverage = 0;  ///< part of the face's map that the photo shows
};

inline constexpr int kMapSide = 1024;  ///< of each half

/// The colours of the figure spread over its outline, and its opacity.
struct Figure {
  fsm::Image colours;
  FloatImage opacity;
};
Figure CutOut(const fsm::Image& photo, const std::vector<float>& person);

/// A photo of the person from the side.
struct SideView {
  View view;
  Figure figure;
  /// Only its outline was used: of a full profile too little is seen from the front, too, to bring
  /// both photos into one light.
  bool outline_only = false;
};

/// Paints both halves and fills the set but for its photo.
TextureBake BakeTexture(const BaseHead& base, const FoundFace& face, const Fit& fit,
                        const fsm::Image& photo, const Figure& figure,
                        std::span<const SideView> sides, fsm::PhotoHead& set);

/// The eyes without the photo's expression. Of the squint of a smile half is kept: how wide they
/// would be without it was not seen, and eyes that are too wide stare.
std::array<fsm::EyeTransform, 2> EyesAtRest(const BaseHead& base, const Fit& fit);
/// Colours of iris and white, from the photo.
void SampleEyes(const FoundFace& face, const Fit& fit, const fsm::Image& photo,
                fsm::PhotoHead& set);
/// Paints the irises and what is between the lids beside them into a corner of the picture that
/// shows nothing else. What lids and irises hide is completed by what is seen round it. Does
/// nothing where an iris is not seen clearly.
void PaintEyes(const BaseHead& base, const FoundFace& face, const Fit& fit, const fsm::Image& photo,
               fsm::Image& picture, fsm::PhotoHead& set);
inline constexpr float kLeastIris = 3;  ///< radius in pixels of what is worth showing
/// Colour of the lips where they turn inward, and how bright teeth are in its light.
void SampleMouth(const FoundFace& face, const fsm::Image& photo, fsm::PhotoHead& set);

/// How many pixels outside (negative: within) a closed line through points of the face `pixel` is.
float Outside(const FoundFace& face, std::span<const int> outline, glm::vec2 pixel);

}  // namespace facefit
