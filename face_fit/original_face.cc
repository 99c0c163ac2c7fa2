#include "face_fit/original_face.h"

#include <algorithm>
#include <stdexcept>

#include "face_fit/image/filters.h"
#include "face_fit/image/photo.h"
#include "fsm/faces/original_config.h"
#include "fsm/image/image_file.h"
#include "fsm/mesh/original/pnt_file.h"
#include "vm_protocol/core/or_throw.h"

namespace facefit {

OriginalFace ReadOriginalFace(const std::string& config_path, const std::string& name) {
  const auto config = vm::OrThrow(fsm::OriginalConfig::Read(config_path));
  const auto mask = std::ranges::find(config.faces, name, &fsm::OriginalFaceFiles::name);
  if (mask == config.faces.end()) {
    std::string names;
    for (const auto& other : config.faces) names += " " + other.name;
    throw std::runtime_error(config_path + " has no face '" + name + "'; it has" +
                             (names.empty() ? " none" : ":" + names));
  }
  OriginalFace face;
  // Points refer to a photo of at most that size.
  face.photo = ScaledToFit(vm::OrThrow(fsm::ReadImage(mask->picture)), kWorkingSize);
  const auto wireframe = vm::OrThrow(fsm::ReadPnt(mask->wireframe));
  face.points = vm::OrThrow(
      PointsOfWireframe(mask->wireframe, wireframe, face.photo.width, face.photo.height));
  return face;
}

}  // namespace facefit
