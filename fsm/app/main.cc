// The face synthesis module: lines on stdin or a socket in, a moving face out.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/app/contact_sheet.h"
#include "fsm/app/fsm_module.h"
#include "fsm/app/gl_face_view.h"
#include "fsm/asset/describe.h"
#include "fsm/base/large_pages.h"
#include "fsm/base/notice.h"
#include "fsm/faces/face_folder.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/faces/head_cache.h"
#include "fsm/faces/head_of_file.h"
#include "fsm/faces/original_faces.h"
#include "fsm/faces/table_folder.h"
#include "fsm/head/identity.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/runtime/module_main.h"

namespace {

struct Options {
  bool headless = false;
  bool window = false;
  std::string context;
  std::string rig = "best";
  std::string size;
  std::vector<int> size_pair;
  std::vector<int> position;
  std::string config;
  std::string head;
  std::string cache;
  std::string export_file;
  bool describe = false;
  std::string sheet;
  std::string out;
  bool no_labels = false;
  fsm::FsmOptions module;
};

/// Whether a word is a whole number.
bool IsNumber(std::string_view word) {
  if (word.starts_with('-')) word.remove_prefix(1);
  return !word.empty() && std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; });
}

/// The original's `-p X Y`, the place of the window, becomes --position; `-p PORT` with one number
/// stays what it is in all modules, its socket.
std::vector<char*> WithPlaceNamed(int argc, char** argv, std::string& position) {
  std::vector<char*> words(argv, argv + argc);
  for (std::size_t i = 1; i + 2 < words.size(); ++i) {
    if (std::string_view(words[i]) == "-p" && IsNumber(words[i + 1]) && IsNumber(words[i + 2])) {
      words[i] = position.data();
    }
  }
  return words;
}

bool DisplayNamed() {
  const char* x11 = std::getenv("DISPLAY");
  const char* wayland = std::getenv("WAYLAND_DISPLAY");
  return (x11 != nullptr && *x11 != '\0') || (wayland != nullptr && *wayland != '\0');
}

bool WindowWanted(const Options& options) {
  if (!options.context.empty()) return options.context == "window";
  return options.window || (!options.headless && DisplayNamed());
}

fsm::OffScreen OffScreenWanted(const Options& options) {
  return options.context == "egl"    ? fsm::OffScreen::kEgl
         : options.context == "auto" ? fsm::OffScreen::kAny
                                     : fsm::OffScreen::kOsMesa;
}

fsm::RigOn RigWanted(const Options& options) {
  return options.rig == "card"        ? fsm::RigOn::kCard
         : options.rig == "processor" ? fsm::RigOn::kProcessor
                                      : fsm::RigOn::kBest;
}

/// --version says on stderr what would draw, too; the version alone is on stdout, as of every
/// program.
void TellRenderer(CLI::App& app, const Options& options) {
  // The runtime adds its own flag after our options, so it is replaced when parsing begins.
  app.preparse_callback([&app, &options](std::size_t) {
    app.set_version_flag("--version", [&options]() -> std::string {
      std::cerr << "fsm: renderer off screen: " << fsm::DescribeOffScreen(OffScreenWanted(options))
                << "\n";
      return "fsm (Galatea) " GALATEA_VERSION;
    });
  });
}

void AddOptions(CLI::App& app, Options& options) {
  TellRenderer(app, options);
  app.add_flag("--headless", options.headless, "Draw without a window, only what is asked for");
  app.add_flag("--window", options.window,
               "Draw in a window (the default where there is a display)");
  app.add_option("--context", options.context,
                 "What draws: osmesa (software, the default of --headless), egl (off screen: a "
                 "graphics card, else what Mesa has), auto (egl, else osmesa) or window")
      ->envname("GALATEA_CONTEXT")
      ->check(CLI::IsMember({"osmesa", "egl", "auto", "window"}));
  app.add_option("--rig", options.rig,
                 "What moves the face's vertices: processor, card (needs OpenGL 4.3) or best (the "
                 "default: a graphics card where one draws)")
      ->check(CLI::IsMember({"best", "processor", "card"}));
  app.add_option("--size", options.size, "Size of the view, WxH (default 640x480)");
  app.add_option("-s", options.size_pair, "The same, as the original: -s W H")->expected(2);
  app.add_option("--position", options.position, "Place of the window, X Y; -p X Y, too")
      ->expected(2);
  app.add_option("-C", options.config, "A configuration file of the original (config.txt)");
  app.add_option(
      "--tables", options.module.tables,
      "A folder of tables (mouth_shapes.txt, emotions.txt, ...) in place of the built-in");
  app.add_option("--mask", options.module.mask, "The face worn at the start (default galatea)");
  app.add_option("--head", options.head,
                 "A head from elsewhere, .obj, .glb, .gltf or .vrm, worn at the start");
  app.add_option(
         "--cache", options.cache,
         "A folder that keeps the heads of files once they are baked, so that they start at "
         "once the next time")
      ->envname("GALATEA_HEAD_CACHE");
  app.add_option("--export", options.export_file,
                 "Writes the face named by --mask or --head with ARKit's shapes as .glb and ends");
  app.add_flag("--describe", options.describe,
               "Tells what the face named by --mask or --head is made of, and ends");
  app.add_option(
      "--background", options.module.background,
      "What is behind the agent at the start, as slot Background: plain (default), studio, "
      "a picture, #rrggbb or transparent");
  app.add_option("--life", options.module.life,
                 "What the face does by itself from the start: OFF (default), CALM, LIVELY, ...");
  auto* const sheet = app.add_option(
      "--sheet", options.sheet,
      "Draws a contact sheet (aus, emotions, visemes or identities) to --out and ends");
  app.add_option("--out", options.out, "The sheet's file, .png or .bmp")->needs(sheet);
  app.add_flag("--no-labels", options.no_labels, "Draws the sheet without names")->needs(sheet);
  app.add_option("--seed", options.module.seed, "Of what the face does by itself (default 1)");
}

/// Faces beside the built-in ones, the one to be worn first of all.
std::vector<fsm::NamedFace> MoreFaces(const Options& options, const fsm::OriginalConfig& config) {
  auto [faces, left_out] = fsm::OriginalFaces(config.masks, config.shared, options.module.tables);
  for (const std::string& what : left_out) fsm::Notice(what);
  if (!options.head.empty()) {
    if (!std::filesystem::is_regular_file(options.head))
      throw std::runtime_error("--head: there is no file '" + options.head + "'");
    std::string name = std::filesystem::path(options.head).stem().string();
    for (char& c : name) {
      if (!fsm::IsFaceName(std::string_view(&c, 1))) c = '_';
    }
    faces.insert(faces.begin(), {name.empty() ? "head" : name,
                                 [file = options.head, tables = options.module.tables,
                                  cache = fsm::HeadCache(options.cache)] {
                                   return cache.HeadOfFile(file, tables);
                                 }});
  }
  return faces;
}

/// The face named by --head or --mask. Throws as MakeHeadOfFile and MakeHeadOfName.
std::unique_ptr<fsm::Head> HeadAsked(const Options& options) {
  const std::string& tables = options.module.tables;
  if (!options.head.empty()) return fsm::HeadCache(options.cache).HeadOfFile(options.head, tables);
  const std::string& name = options.module.mask;
  return fsm::MakeHeadOfName(name.empty() ? fsm::Identities().front() : name, tables);
}

/// Writes or describes a head, for a run that does nothing else.
void ExportOrDescribe(const Options& options) {
  const auto tables = vm::OrThrow(fsm::MotionTables::Load(options.module.tables));
  const auto head = HeadAsked(options);
  if (options.describe) std::cout << fsm::Describe(*head) << std::flush;
  if (!options.export_file.empty()) {
    vm::OrThrow(fsm::ExportHead(*head, tables, options.export_file));
  }
}

fsm::GlFaceView::Options ViewOptions(const Options& options) {
  fsm::GlFaceView::Options view;
  view.width = options.module.config.width.value_or(view.width);
  view.height = options.module.config.height.value_or(view.height);
  if (!options.size_pair.empty()) {
    view.width = options.size_pair[0];
    view.height = options.size_pair[1];
  }
  if (!options.size.empty()) {
    char end = '\0';
    if (std::sscanf(options.size.c_str(), "%dx%d%c", &view.width, &view.height, &end) != 2) {
      throw std::runtime_error("--size " + options.size + " is not WIDTHxHEIGHT, as 640x480");
    }
  }
  const auto fits = [](int side) { return side >= 16 && side <= fsm::kMaxImageSide; };
  if (!fits(view.width) || !fits(view.height)) {
    throw std::runtime_error("the view must be 16 to " + std::to_string(fsm::kMaxImageSide) +
                             " pixels wide and high");
  }
  view.off_screen = OffScreenWanted(options);
  view.rig = RigWanted(options);
  const fsm::OriginalConfig& config = options.module.config;
  if (config.x && config.y) view.position = {*config.x, *config.y};
  if (!options.position.empty()) view.position = {options.position[0], options.position[1]};
  view.tables = options.module.tables;
  // They are read here only so that damaged ones end the start.
  static_cast<void>(fsm::UnitsIn(view.tables));
  static_cast<void>(fsm::FeaturesIn(view.tables));
  using Where = fsm::GlFaceView::Options::Where;
  const bool must = options.window || options.context == "window";
  view.where = must && WindowWanted(options) ? Where::kWindow
               : WindowWanted(options)       ? Where::kWindowIfPossible
                                             : Where::kHeadless;
  return view;
}

/// Tells what is odd about the folder of --tables.
void CheckTablesGiven(const Options& options) {
  for (const std::string& notice : vm::OrThrow(fsm::CheckTables(options.module.tables))) {
    fsm::Notice(notice);
  }
}

/// The faces of a sheet of identities: the one asked for, else the built-in ones and those of the
/// command line. Faces kept in the user's folder are private, and may be damaged.
std::vector<std::string> FacesShown(const std::string& asked,
                                    const std::vector<fsm::NamedFace>& more) {
  if (!asked.empty()) return {asked};
  std::vector<std::string> names;
  for (const fsm::NamedFace& face : more) names.push_back(face.name);
  names.insert(names.end(), fsm::Identities().begin(), fsm::Identities().end());
  return names;
}

/// Draws a contact sheet, for a run that does nothing else.
void DrawSheet(const Options& options) {
  if (options.out.empty()) throw std::runtime_error("--sheet needs --out FILE.png");
  const auto tables = vm::OrThrow(fsm::MotionTables::Load(options.module.tables));
  fsm::OriginalConfig config;
  if (!options.config.empty()) config = vm::OrThrow(fsm::OriginalConfig::Read(options.config));
  const auto more = MoreFaces(options, config);
  fsm::HeadWardrobe wardrobe(more, options.module.tables);
  fsm::GlFaceView view(wardrobe, {.width = fsm::kCellWidth,
                                  .height = fsm::kCellHeight,
                                  .off_screen = OffScreenWanted(options),
                                  .rig = RigWanted(options),
                                  .tables = options.module.tables});
  const std::string& face = options.module.mask;
  if (!face.empty()) vm::OrThrow(wardrobe.Wear(face));
  const auto sheet =
      vm::OrThrow(fsm::MakeSheet(options.sheet, tables, FacesShown(face, more), face));
  const auto picture = vm::OrThrow(fsm::DrawSheet(view, wardrobe, sheet, !options.no_labels));
  vm::OrThrow(fsm::WriteImage(picture, options.out));
}

/// The exit code of a run that reads no lines; -1 if the options ask for none.
int RunOnce(const Options& options) {
  try {
    CheckTablesGiven(options);
    if (!options.export_file.empty() || options.describe) {
      ExportOrDescribe(options);
    } else if (!options.sheet.empty()) {
      DrawSheet(options);
    } else {
      return -1;
    }
  } catch (const std::exception& error) {
    std::cerr << "fsm: " << error.what() << "\n";
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  fsm::UseLargePages();
  Options options;
  bool failed = false;
  options.module.on_failure = [&failed] { failed = true; };
  // Both outlive the module.
  std::optional<fsm::HeadWardrobe> wardrobe;
  std::optional<fsm::GlFaceView> view;
  std::string position = "--position";
  std::vector<char*> words = WithPlaceNamed(argc, argv, position);
  const int code = vm::RunModule(
      argc, words.data(),
      {.name = "fsm",
       .description = "Galatea's face: a talking head told what to do in lines of text",
       .module_name = "FSM",
       .original_port = 10700,
       .virtual_by_default = true,
       .add_options = [&options](CLI::App& app) { AddOptions(app, options); },
       .before_start = [&options] { return RunOnce(options); },
       .needs_real_clock = [&options] { return WindowWanted(options); },
       .make = [&options, &wardrobe, &view](
                   vm::Scheduler& clock, boost::asio::io_context&) -> std::unique_ptr<vm::Module> {
         if (!options.config.empty()) {
           auto config = vm::OrThrow(fsm::OriginalConfig::Read(options.config));
           config.expressions = fsm::LooksOfExpressions(config.shared);
           options.module.config = std::move(config);
           options.module.announce_config = true;
         }
         const auto view_options = ViewOptions(options);
         wardrobe.emplace(MoreFaces(options, options.module.config), options.module.tables);
         view.emplace(*wardrobe, view_options);
         return std::make_unique<fsm::FsmModule>(clock, *view, *wardrobe, fsm::MediaFiles{},
                                                 options.module);
       }});
  return code == 0 && failed ? 1 : code;
}
