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

/// The options of the program's command line.
struct Options {
  FsmOptions module;
  GlFaceView::Options view;
  std::vector<NamedFace> faces;  ///< in addition to the built-in ones; the initial face comes first

  // Options after which the program ends at once (RunOnce); "" and false = not given.
  std::string export_file;
  bool describe = false;
  std::string sheet, sheet_file;
  bool labels = true;  ///< whether the sheet has labels

  // The input of ResolveOptions.
  std::string config_path, head_path, cache_folder, size_text;
  std::optional<std::pair<int, int>> size_pair;
};

/// Returns the arguments with `-p X Y`, the original's option for the window's position, replaced
/// by --position. `-p PORT` with one number is unchanged: in all modules it is the port of the
/// socket.
std::vector<char*> NamePositionOption(int argc, char** argv);

/// Adds the options to those that all modules have. Parsing fills `options`, which outlives `app`.
void AddOptions(CLI::App& app, Options& options);

/// Reads the files that the options name: stores the configuration in options.module, uses its
/// settings of the view for options not given, and adds the faces of --head and of the
/// configuration. Anomalies in these and in the folder of --tables go to options.module.log. Throws
/// std::runtime_error.
void ResolveOptions(Options& options);

}  // namespace fsm
