#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "face_editor/app/ui.h"

namespace editor {

/// Lines of a file or of stdin, as they come; never blocks. Owns nothing: the descriptor is closed
/// by whoever opened it. Limit: kMaxLineBytes; a longer line is cut there and so not understood.
class LineSource {
 public:
  static constexpr std::size_t kMaxLineBytes = 65536;
  explicit LineSource(int descriptor) : descriptor_(descriptor) {}
  std::optional<std::string> Next();
  bool ended() const { return ended_ && text_.empty(); }
  int line() const { return line_; }  ///< the number of the one given last

 private:
  int descriptor_;
  std::string text_;
  bool ended_ = false;
  int line_ = 0;
};

/// What commands of a script can do to the program that runs them.
struct Program {
  Ui& ui;
  std::function<vm::Result<void>(const std::string& picture)> frame;  ///< draws one
  std::function<void(vm::Time)> pass;  ///< lets so much time pass, drawing
  /// Waits until the face is made, then draws. Error: why the last one was not.
  std::function<vm::Result<void>()> settle;
  bool quit = false;
};

/// Runs one line, commands of the editor and those of the window (docs/face_editor.md), and draws
/// what came of it. Gives what it answers. Errors: theirs; kUnknownCommand.
vm::Result<std::string> RunLine(Program& program, const std::string& line);

}  // namespace editor
