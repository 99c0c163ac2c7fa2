#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fsm/head/photo_head.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Returns the folder of faces: $GALATEA_FACES, else $XDG_DATA_HOME/galatea/faces, else
/// ~/.local/share/galatea/faces. It has a subfolder for each face made from a photo (face.txt) or
/// from a built-in face (identity.txt).
std::string FacesFolder();
/// Tells whether a name consists of at most 64 letters, digits, - and _.
bool IsFaceName(std::string_view name);
/// Returns the names of the faces in a folder, sorted; empty if the folder does not exist.
std::vector<std::string> FacesIn(const std::string& folder);

/// Writes the subfolder of a face from a photo into `folder` ("" = FacesFolder()) and returns its
/// path. Errors: kBadValue if not IsFaceName, kUnavailable. REQUIRES: head.atlas
vm::Result<std::string> WriteFace(const PhotoHead& head, std::string_view report,
                                  const std::string& folder, const std::string& name);

}  // namespace fsm
