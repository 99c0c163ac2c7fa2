#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "fsm/render/eye_finder.h"
#include "fsm/render/mouth_finder.h"
#include "fsm/render/shadow_finder.h"
#include "fsm/render/skin_creases.h"
#include "fsm/render/skin_painting.h"
#include "fsm/rig/head.h"

namespace fsm {

/// What drawing knows about a head apart from GL objects: its surface, the finders, which measure
/// every frame, and what is measured once, at rest.
struct HeadDescription {
  /// `rest`: the head's vertices at rest. `appearance` outlives this.
  HeadDescription(const Head& head, const HeadVertices& rest, const Appearance& appearance);

  /// The texture on skin and clothes; null if the skin is painted.
  const Image* base_colour() const { return surface->textures.base_colour.get(); }
  /// Returns the vertices that the finders read.
  std::vector<std::uint32_t> MeasuredVertices() const;

  std::shared_ptr<const HeadSurface> surface;
  EyeFinder eyes;
  ShadowFinder shadows;
  MouthFinder mouth;
  Sided<MeasuredEye> resting_eyes;  ///< REQUIRES: eyes.found()
  /// The photo's resolution on the head as seen from the front; 0 without a photo.
  float photo_texels_per_mm;
  std::optional<float> chin_y;  ///< height of the chin's lowest point, millimetres
  CreaseWeights creases;
  SkinPainting skin;  ///< paints nothing if the head lacks landmarks of its features
};

}  // namespace fsm
