#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fsm/mesh/head_file.h"
#include "fsm/mesh/mesh_model.h"

namespace fsm {

/// What a shape of that name stands for, "mouthsmileleft" in small letters.
struct ShapeMeaning {
  std::string name;
  FaceState state;
};
/// Shapes look as `source` does in their states.
struct ShapeMeanings {
  const Head& source;
  std::span<const ShapeMeaning> shapes;
};
/// The rig of skin that is moved by the file's own shapes, those whose names have a meaning: units,
/// the mouth's parameters and the rest drive them as is needed to look like `moved` where they act
/// alone, and in `visemes`. A name of both sides (browInnerUp) may come as two halves with Left and
/// Right behind it; each then stands for its side. A unit of whose movement the shapes can show
/// hardly anything drives none of them. `moved` is the source of the meanings, with other units
/// perhaps. What the shapes move in `model` is flesh then, teeth too. Nothing if there are fewer
/// than four. `unused` gets the names of shapes that move something but have no meaning.
std::optional<RigData> BlendshapeRig(const HeadFile& file, const Similarity& to_ours,
                                     MeshModel& model, const ShapeMeanings& meanings,
                                     const Head& moved, std::span<const FaceState> visemes = {},
                                     std::vector<std::string>* unused = nullptr);

}  // namespace fsm
