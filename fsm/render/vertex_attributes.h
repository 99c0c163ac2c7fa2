#pragma once

#include <GL/glcorearb.h>

#include <array>

namespace fsm {

/// What a vertex brings to the shaders, at the locations by which shaders/*.glsl ask for it. Skin
/// and hair, which have shaders of their own, put different things at three of them.
struct VertexAttribute {
  enum Location : GLuint {
    kPosition,        ///< millimetres
    kNormal,          ///< unit
    kRestPosition,    ///< millimetres
    kAlbedoOpenness,  ///< linear RGB, of lids ShutLid::colour; openness to light, 0..1
    kDetailPlace,     ///< skin: HeadTopology::uv; hair: Strand::tile_mm
    kDetail,          ///< skin: CreaseWeights::face; hair: Strand::along and density
    kDetailMore,      ///< skin: CreaseWeights::nose_and_left; hair: Strand::across
    kTexcoord,        ///< TextureMaps::texcoord and weight; ShutLid::weight
    kLidGrain,        ///< ShutLid::grain_at and slide
    kOpacity,         ///< HeadTopology::opacity
    kRelitNormal,     ///< the normal at rest, as long as Portrait::relit
    kLidSkin,         ///< 1 where there is a ShutLid, else 0; its grain_light
    kCount
  };
  /// Numbers of each.
  static constexpr std::array<GLint, kCount> kWidth{3, 3, 3, 4, 2, 4, 2, 4, 4, 1, 3, 2};
};

}  // namespace fsm
