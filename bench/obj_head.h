#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <string>

#include "fsm/rig/head.h"

namespace fsm::bench {

/// Somebody else's head, as it is put in front of our renderer: read from a Wavefront file, given
/// our palette, brought to our size and place by its eyes. It does not move.
struct ObjSource {
  std::string name;
  std::filesystem::path folder;  ///< holds neutral.obj, and landmarks68.txt if there is one
  float millimetres;             ///< of the file's unit
  std::map<std::string, Material>
      groups;  ///< what each group of faces is made of; others are left out
};

/// Eyeballs are made anew in the size and place of the group's, because helper spheres have no
/// iris. With 68 landmarks (iBUG order) lips and brows are coloured and the skin has the same
/// detail as ours. `eyes`: middle between our eyeballs. Throws std::runtime_error with a sentence
/// if a file is missing or damaged.
std::unique_ptr<Head> ReadObjHead(const ObjSource& source, const glm::vec3& eyes);

}  // namespace fsm::bench
