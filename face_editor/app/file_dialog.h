#pragma once

#include <functional>
#include <string>
#include <vector>

#include "face_editor/core/file_list.h"

namespace editor {

struct Ui;

/// A window in the window: the files of a folder, one of which is chosen for something.
struct FileDialog {
  /// A button: what it is called and what it does with the path. The dialog goes where that
  /// succeeds, and shows the error where not.
  struct Choice {
    std::string label;
    bool writes = false;  ///< asks before it replaces a file
    std::function<vm::Result<void>(const std::string& path)> run;
  };
  std::string title;
  FileKind kind = FileKind::kPhoto;
  std::vector<Choice> choices;

  std::string folder;  ///< where it was left, "" = the working directory
  std::string name;    ///< typed or clicked, within the folder or a whole path
  bool all = false;
  std::vector<FileEntry> entries;
  std::string error;
  std::string replaces;  ///< the file a second press of its button replaces
  bool opens = false, open = false;
};

/// Opens it, beginning where `path` lies.
void Browse(Ui& ui, std::string title, FileKind kind, const std::string& path,
            std::vector<FileDialog::Choice> choices);
/// Draws it if it is open.
void DrawFileDialog(Ui& ui);

}  // namespace editor
