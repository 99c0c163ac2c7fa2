#pragma once

#include <string>
#include <vector>

#include "face_editor/app/script.h"

/// What commands of a script do in place of a mouse.
namespace editor {

/// As many words as numbers, from `first` on. Error: kSyntax.
vm::Result<std::vector<float>> Numbers(const std::vector<std::string>& words, std::size_t first,
                                       std::size_t count);
/// Draws so many frames: widgets answer over a few.
void Draw(Program& program, int frames);
void ClickAt(Program& program, ImVec2 place);
/// mouse move, down, up, wheel, drag or off.
vm::Result<std::string> MoveMouse(Program& program, const std::vector<std::string>& words);

}  // namespace editor
