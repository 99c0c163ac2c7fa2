#pragma once

#include <string>
#include <string_view>

namespace editor {

/// A name for the face of a photo: that of its file without folder and ending, what a face's name
/// cannot have made _, at most 64 bytes; "face" where nothing is left of it. Pure.
std::string FaceNameOf(std::string_view photo);

}  // namespace editor
