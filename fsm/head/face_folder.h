#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fsm {

/// Faces from photos (face.txt) and those made of built-in ones (identity.txt) lie in folders of
/// one folder: $GALATEA_FACES, else $XDG_DATA_HOME/galatea/faces, else
/// ~/.local/share/galatea/faces.
std::string FacesFolder();
/// Letters, digits, - and _, at most 64.
bool IsFaceName(std::string_view name);
/// The names of those there are, in order; nothing if the folder is not there.
std::vector<std::string> FacesIn(const std::string& folder);

}  // namespace fsm
