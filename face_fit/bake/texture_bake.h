#pragma once

#include "face_fit/fit/side_view.h"
#include "fsm/head/photo_head.h"

namespace facefit {

/// The texture of a head made from a photo. Left half: the skin, laid out by the head's texture
/// coordinates, alpha = how much is skin. Right half: the figure with hair, neck and clothes, and
/// its opacity.
struct TextureBake {
  fsm::Image picture;
  float coverage = 0;  ///< part of the face's map that the photo shows
};

inline constexpr int kMapSide = 1024;  ///< of each half

/// Paints both halves and fills in the rest of `head`, all but `head.photo`. `figure`: of `photo`;
/// `sides`: photos of the same person from the side, may be empty. Pure; thread: any.
TextureBake BakeTexture(const BaseHead& base, const FoundFace& face, const Fit& fit,
                        const fsm::Image& photo, const Figure& figure,
                        std::span<const SideView> sides, fsm::PhotoHead& head);

}  // namespace facefit
