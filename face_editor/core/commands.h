#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "face_editor/core/editor.h"

namespace editor {

/// A line of a script in words; one between "" may hold blanks. A word that begins with # ends it.
/// Error: kSyntax for a missing ".
vm::Result<std::vector<std::string>> CommandWords(std::string_view line);

/// Runs a command that needs no window (docs/face_editor.md lists them) and gives what it answers,
/// "" if nothing. Nothing at all: the command is none of these. Errors: the editor's; kSyntax names
/// the words expected.
std::optional<vm::Result<std::string>> RunCommand(Editor& editor,
                                                  const std::vector<std::string>& words);

}  // namespace editor
