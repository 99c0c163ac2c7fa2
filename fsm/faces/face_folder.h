#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fsm/head/photo_head.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Faces from photos (face.txt) and those made of built-in ones (identity.txt) lie in folders of
/// one folder: $GALATEA_FACES, else $XDG_DATA_HOME/galatea/faces, else
/// ~/.local/share/galatea/faces.
std::string FacesFolder();
/// Letters, digits, - and _, at most 64.
bool IsFaceName(std::string_view name);
/// The names of those there are, in order; nothing if the folder is not there.
std::vector<std::string> FacesIn(const std::string& folder);

/// Writes the folder of a face from a photo into `folder` ("" = FacesFolder()), and says where it
/// is. Errors: kBadValue for another name, kUnavailable. REQUIRES: head.photo
vm::Result<std::string> WriteFace(const PhotoHead& head, std::string_view report,
                                  const std::string& folder, const std::string& name);

}  // namespace fsm
