#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fsm/mesh/rigging/known_shapes.h"

namespace fsm {

/// What shapes mean: a shape looks as `source` does in the state given for its name.
struct ShapeMeanings {
  const Head& source;
  std::span<const ShapeMeaning> shapes;
};
struct BlendshapeRig {
  std::optional<RigData> rig;       ///< none if fewer than four shapes have a meaning
  std::vector<std::string> unused;  ///< shapes that move vertices but have no meaning
};
/// Makes a rig that moves the skin by those of the file's shapes whose names are in `meanings`.
/// Units, the mouth's parameters and the other channels drive the shapes so that the face looks
/// like `driven` when one of them acts alone, and in the states `visemes`. `driven`: the same head
/// as `meanings.source`, perhaps with other units. A file may split a shape of both sides
/// (browInnerUp) into two, with Left and Right after its name. A unit drives no shape if the shapes
/// can reproduce hardly any of its movement. Vertices of `model` that the shapes move, teeth
/// included, become flesh.
BlendshapeRig MakeBlendshapeRig(const ImportedHead& file, const Similarity& to_ours,
                                UnriggedHead& model, const ShapeMeanings& meanings,
                                const Head& driven, std::span<const FaceState> visemes = {});

}  // namespace fsm
