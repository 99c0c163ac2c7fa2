#pragma once

#include <memory>

#include "fsm/render/head_measures.h"
#include "fsm/render/skin_creases.h"
#include "fsm/render/skin_painting.h"
#include "fsm/rig/head.h"

namespace fsm {

/// What drawing knows about a head apart from GL objects.
struct HeadDescription {
  /// `rest`: the head's vertices at rest. `appearance` outlives this.
  HeadDescription(const Head& head, const HeadVertices& rest, const Appearance& appearance);

  /// The texture on skin and clothes; null if the skin is painted.
  const Image* base_colour() const { return surface->textures.base_colour.get(); }

  std::shared_ptr<const HeadSurface> surface;
  HeadMeasures measures;
  CreaseWeights creases;
  SkinPainting skin;  ///< paints nothing if the head lacks landmarks of its features
};

}  // namespace fsm
