#pragma once

#include <GL/glcorearb.h>

#include <array>

#include "fsm/base/enum_names.h"

namespace fsm {

/// The vertex attributes. CompileLit defines their locations by name in the shaders. Skin and hair,
/// which have separate shaders, use three locations differently.
struct VertexAttribute {
  enum Location : GLuint {
    kPosition,        ///< millimetres
    kNormal,          ///< unit length
    kRestPosition,    ///< millimetres
    kAlbedoOpenness,  ///< linear RGB (on lids ShutLid::colour); openness to light, 0..1
    kDetailTexcoord,  ///< skin: HeadSurface::uv; hair: Strand::tile_mm
    kDetail,          ///< skin: CreaseWeights::face; hair: Strand::along and density
    kDetailMore,      ///< skin: CreaseWeights::more; hair: Strand::across, thins at outline
    kTexcoord,        ///< TextureMaps::texcoord and weight; ShutLid::weight
    kLidGrain,        ///< ShutLid::grain_at and slide
    kOpacity,         ///< HeadSurface::opacity
    kRelitNormal,     ///< rest normal, scaled by Portrait::relit
    kLidSkin          ///< 1 where there is a ShutLid, else 0; its grain_light
  };
  static constexpr GLuint kCount = kValuesOf<Location>;
  /// Number of components of each attribute.
  static constexpr std::array<GLint, kCount> kWidth{3, 3, 3, 4, 2, 4, 3, 4, 4, 1, 3, 2};
};

}  // namespace fsm
