#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fsm/app/fsm_module.h"
#include "fsm/app/gl_face_view.h"
#include "fsm/faces/original_faces.h"

namespace CLI {
class App;
}

namespace fsm {

/// What the command line of the program says.
struct Options {
  FsmOptions module;
  GlFaceView::Options view;
  std::vector<NamedFace> faces;  ///< beside the built-in ones, the one to be worn first of all

  // Runs that end at once; "" and false = not asked for.
  std::string export_file;
  bool describe = false;
  std::string sheet, sheet_file;
  bool labels = true;  ///< of the sheet

  // What Complete reads.
  std::string config, head, cache, size;
  std::optional<std::pair<int, int>> size_pair;
};

/// The words of the command line with the original's `-p X Y`, the place of the window, as
/// --position; `-p PORT` with one number stays what it is in all modules, its socket.
std::vector<char*> WithPlaceNamed(int argc, char** argv);

/// Adds the options to those of all modules. `options` is filled when the words are parsed; it
/// outlives `app`.
void AddOptions(CLI::App& app, Options& options);

/// Reads what the words name: the configuration goes into options.module, and what it says of the
/// view holds where the words say nothing; the faces are those of --head and of the configuration.
/// Tells on stderr what is odd about them and the folder of --tables. Throws std::runtime_error
/// with a sentence.
void Complete(Options& options);

}  // namespace fsm
