#pragma once

#include <span>
#include <string>
#include <vector>

#include "fsm/rig/head.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// A shape to write: what it is called, and the state that shows it at full strength.
struct ExportedShape {
  std::string name;
  FaceState state;
};

/// The head at rest as binary glTF 2.0 in metres, looking towards +z, with each shape as a morph
/// target (sparse: only what moves is stored) named in extras.targetNames. Colours are those of the
/// vertices; one primitive for each material.
std::string WriteGltfHead(const Head& head, std::span<const ExportedShape> shapes);

}  // namespace fsm
