// Faces edited by hand in a window: points on a photo, units, expressions, mouth shapes, movements.

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include "face_editor/app/given_head.h"
#include "face_editor/app/script.h"
#include "fsm/faces/face_folder.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/faces/table_names.h"
#include "vm_protocol/core/or_throw.h"

namespace {

using namespace std::chrono_literals;

struct Options {
  std::string photo, mask, head, tables, points, networks, script;
  int width = 1280, height = 800;
  std::string size;
};

/// With --head, --mask names a face of a configuration.
editor::MadeHead GivenHead(const Options& options) {
  if (!options.head.empty()) {
    return vm::OrThrow(editor::OpenHead(options.head, options.mask, options.tables));
  }
  if (options.mask.empty()) return {};
  return {fsm::MakeHeadOfName(options.mask, options.tables), nullptr, "", nullptr};
}

/// A descriptor of a script; -1 = none. Closed at the end, unless it is stdin.
class ScriptFile {
 public:
  explicit ScriptFile(const std::string& path) {
    if (path.empty()) return;
    descriptor_ = path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor_ < 0) throw std::runtime_error("cannot read '" + path + "'");
  }
  ~ScriptFile() {
    if (descriptor_ > STDIN_FILENO) ::close(descriptor_);
  }
  ScriptFile(const ScriptFile&) = delete;
  ScriptFile& operator=(const ScriptFile&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
};

/// The program from its first frame to its last. With a script out of a file time is counted in
/// frames, so that what it draws is always the same.
class Run {
 public:
  explicit Run(const Options& options)
      : options_(options),
        file_(options.script),
        lines_(file_.descriptor()),
        editor_(vm::OrThrow(editor::Editor::Make(options.tables))),
        window_(options.width, options.height),
        given_(GivenHead(options)),
        stage_(window_.context(), given_),
        player_(*editor_),
        ui_{*editor_, player_, stage_, window_} {
    ui_.folder = ui_.tables = options.tables;
    if (!given_.notice.empty()) ui_.Tell(given_.notice);
    program_.frame = [this](const std::string& picture) { return Frame(picture); };
    program_.pass = [this](vm::Time time) {
      for (const vm::Time end = ui_.now + time; ui_.now < end;) static_cast<void>(Frame(""));
    };
    program_.settle = [this] {
      vm::Result<void> worst;
      do {
        static_cast<void>(window_.Wait(0.02));
        if (auto done = editor::UpdateStage(ui_); !done) worst = done;
      } while (stage_.busy());
      static_cast<void>(Frame(""));
      return worst;
    };
  }

  /// The exit code.
  int Go() {
    static_cast<void>(Frame(""));  // so that something is seen while networks and photo are read
    Open();
    while (!Ended()) {
      if (!RunScript()) return 1;
      if (Ended()) break;
      Idle();
    }
    return 0;
  }

 private:
  bool counted() const { return file_.descriptor() > STDIN_FILENO && !lines_.ended(); }
  bool Ended() const {
    const bool kept = editor_->UnsavedNames().empty();
    return program_.quit || ui_.closed || (window_.close_requested() && kept);
  }

  void Open() {
    auto models = editor::LoadFaceModels(options_.networks, options_.tables);
    if (models) {
      editor_->SetModels(std::move(*models));
    } else {
      std::cerr << "face_editor: notice: " << models.error().text << "\n";
    }
    OpenUnitsOfMask();
    if (options_.photo.empty()) {
      const bool head = !options_.mask.empty() || !options_.head.empty();
      if (head) ui_.page = editor::Page::kExpressions;
      return;
    }
    vm::OrThrow(editor::OpenFile(ui_, options_.photo));
    if (!options_.points.empty()) vm::OrThrow(editor_->LoadPoints(options_.points));
  }

  /// A face's own table of units goes before that of the folder of tables.
  void OpenUnitsOfMask() {
    if (options_.mask.empty() || !options_.head.empty()) return;
    const std::string path =
        fsm::FacesFolder() + "/" + options_.mask + "/" + std::string(fsm::kUnitsTable);
    std::error_code code;
    if (!fsm::IsFaceName(options_.mask) || !std::filesystem::exists(path, code)) return;
    vm::OrThrow(editor_->Load(editor::Part::kUnits, path));
    ui_.paths[editor::Part::kUnits] = path;
  }

  vm::Result<void> Frame(const std::string& picture) {
    constexpr vm::Time kTick = 33ms;
    const auto real = std::chrono::steady_clock::now();
    const auto since = std::chrono::duration_cast<vm::Time>(real - before_);
    before_ = real;
    const vm::Time step = counted() ? kTick : std::clamp(since, vm::Time(1), vm::Time(1s));
    ui_.now += step;
    static_cast<void>(editor::UpdateStage(ui_));
    window_.context().MakeCurrent();  // the networks' view of the head has one of its own
    window_.BeginFrame(std::chrono::duration<float>(step).count());
    const fsm::FaceState state = editor::DrawUi(ui_);
    window_.Clear();
    stage_.Draw(ui_.preview, state);
    return window_.EndFrame(picture);
  }

  /// What there is of the script now; false if it failed.
  bool RunScript() {
    if (file_.descriptor() < 0) return true;
    const bool typed = file_.descriptor() == STDIN_FILENO;
    while (!Ended()) {
      const auto line = lines_.Next();
      if (!line) return true;
      const auto answer = editor::RunLine(program_, *line);
      if (answer) {
        if (!answer->empty()) std::cout << *answer << "\n";
        if (typed) std::cout << "ok\n";
        std::cout.flush();
        continue;
      }
      const std::string where = typed ? "stdin" : options_.script;
      std::cerr << "face_editor: " << where << ":" << lines_.line() << ": " << answer.error().text
                << "\n";
      if (!typed) return false;
      std::cout << "error" << std::endl;
    }
    return true;
  }

  /// Draws only while something moves or happens.
  void Idle() {
    const bool moves = player_.playing(ui_.now) || stage_.busy();
    const bool listens = file_.descriptor() >= 0 && !lines_.ended();
    const bool happened = window_.Wait(moves ? 0.005 : listens ? 0.03 : 0.25);
    if (happened) restless_ = 4;  // widgets answer over a few frames
    if (window_.close_requested()) restless_ = 4;
    if (!moves && restless_ == 0) {
      before_ = std::chrono::steady_clock::now();
      return;
    }
    restless_ = std::max(restless_ - 1, 0);
    static_cast<void>(Frame(""));
  }

  const Options& options_;
  ScriptFile file_;
  editor::LineSource lines_;
  std::unique_ptr<editor::Editor> editor_;
  editor::Window window_;
  editor::MadeHead given_;
  editor::Stage stage_;
  editor::Player player_;
  editor::Ui ui_;
  editor::Program program_{ui_, nullptr, nullptr, nullptr};
  std::chrono::steady_clock::time_point before_ = std::chrono::steady_clock::now();
  int restless_ = 4;
};

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Faces edited by hand: points on a photo, units, expressions, mouth shapes, movements");
  app.set_version_flag("--version", "face_editor (Galatea) " GALATEA_VERSION);
  app.add_option("photo", options.photo, "A photo to make a face of, JPEG or PNG");
  app.add_option("--points", options.points, "Points saved before, or set by hand");
  app.add_option("--mask", options.mask, "The face shown while no photo is open, as of fsm");
  app.add_option("--head", options.head,
                 "A head from elsewhere instead: .obj .glb .gltf .vrm, or a "
                 "configuration of the original (config.txt), of which --mask chooses the face");
  app.add_option("--tables", options.tables, "A folder of tables to edit in place of the built-in");
  app.add_option("--networks", options.networks,
                 "Where the networks are (default: where scripts/face_networks.sh puts them)");
  app.add_option("--script", options.script,
                 "Commands to run, from a file or - for stdin (docs/face_editor.md)");
  app.add_option("--size", options.size, "Size of the window, WxH (default 1280x800)");
  CLI11_PARSE(app, argc, argv);
  try {
    char end = '\0';
    if (!options.size.empty() &&
        (std::sscanf(options.size.c_str(), "%dx%d%c", &options.width, &options.height, &end) != 2 ||
         options.width < 640 || options.height < 480 || options.width > 8192 ||
         options.height > 8192)) {
      throw std::runtime_error("--size " + options.size + " is not WIDTHxHEIGHT from 640x480");
    }
    return Run(options).Go();
  } catch (const std::exception& error) {
    std::cerr << "face_editor: " << error.what() << "\n";
    return 1;
  }
}
