#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fsm/mesh/imported_head.h"
#include "fsm/mesh/mesh_model.h"

namespace fsm {

/// The state of the face that a shape stands for. `name`: in small letters, as "mouthsmileleft".
struct ShapeMeaning {
  std::string name;
  FaceState state;
};
/// The shape of each name looks as `source` does in the state beside it.
struct ShapeMeanings {
  const Head& source;
  std::span<const ShapeMeaning> shapes;
};
/// A rig that moves the skin by the file's own shapes, as far as `meanings` has their names. Units,
/// the mouth's parameters and the other channels drive the shapes so that the face looks like
/// `moved` when one of them acts alone, and in the states `visemes`. `moved`: the source of the
/// meanings, which may have other units. A shape of both sides (browInnerUp) may be given as two
/// halves, with Left and Right after its name. A unit drives no shape if the shapes can show hardly
/// anything of its movement. Vertices of `model` that the shapes move, those of teeth too, become
/// flesh. Returns nothing if fewer than four shapes have a meaning. `unused` gets the names of
/// shapes that move something but have no meaning.
std::optional<RigData> MakeBlendshapeRig(const ImportedHead& file, const Similarity& to_ours,
                                         MeshModel& model, const ShapeMeanings& meanings,
                                         const Head& moved, std::span<const FaceState> visemes = {},
                                         std::vector<std::string>* unused = nullptr);

}  // namespace fsm
