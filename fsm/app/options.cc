#include "fsm/app/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string_view>

#include "fsm/faces/face_folder.h"
#include "fsm/faces/head_cache.h"
#include "fsm/faces/table_check.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

using WindowMode = GlFaceView::Options::WindowMode;

const std::map<std::string, OffScreenDriver> kOffScreen = {{"osmesa", OffScreenDriver::kOsMesa},
                                                           {"egl", OffScreenDriver::kEgl},
                                                           {"auto", OffScreenDriver::kAny}};
const std::map<std::string, RigDevice> kRigs = {
    {"best", RigDevice::kBest}, {"processor", RigDevice::kProcessor}, {"card", RigDevice::kGpu}};

bool IsNumber(std::string_view word) {
  if (word.starts_with('-')) word.remove_prefix(1);
  return !word.empty() && std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; });
}

bool DisplayNamed() {
  const char* x11 = std::getenv("DISPLAY");
  const char* wayland = std::getenv("WAYLAND_DISPLAY");
  return (x11 != nullptr && *x11 != '\0') || (wayland != nullptr && *wayland != '\0');
}

/// Makes --version also print the renderer, on stderr; stdout has only the version, as in every
/// program.
void TellRenderer(CLI::App& app, const Options& options) {
  // The runtime adds its own flag after our options, so it is replaced just before parsing.
  app.preparse_callback([&app, &options](std::size_t) {
    app.set_version_flag("--version", [&options]() -> std::string {
      options.module.log("renderer off screen: " + DescribeOffScreen(options.view.off_screen));
      return "fsm (Galatea) " GALATEA_VERSION;
    });
  });
}

/// Adds the options of the renderer. CLI11 runs callbacks in the order of these lines, so the flags
/// override the environment, which may give --context.
void AddDrawing(CLI::App& app, GlFaceView::Options& view) {
  view.window_mode = DisplayNamed() ? WindowMode::kWindowIfPossible : WindowMode::kHeadless;
  app.add_option_function<std::string>(
         "--context",
         [&view](const std::string& word) {
           const auto off_screen = kOffScreen.find(word);
           view.window_mode =
               off_screen == kOffScreen.end() ? WindowMode::kWindow : WindowMode::kHeadless;
           if (off_screen != kOffScreen.end()) view.off_screen = off_screen->second;
         },
         "What draws: osmesa (software, the default of --headless), egl (off screen: a "
         "graphics card, else what Mesa has), auto (egl, else osmesa) or window")
      ->envname("GALATEA_CONTEXT")
      ->check(CLI::IsMember({"osmesa", "egl", "auto", "window"}));
  app.add_flag_callback(
      "--headless", [&view] { view.window_mode = WindowMode::kHeadless; },
      "Draw without a window, only what is asked for");
  app.add_flag_callback(
      "--window", [&view] { view.window_mode = WindowMode::kWindow; },
      "Draw in a window (the default where there is a display)");
  app.add_option_function<std::string>(
         "--rig", [&view](const std::string& word) { view.rig = kRigs.at(word); },
         "What moves the face's vertices: processor, card (needs OpenGL 4.3) or best (the "
         "default: a graphics card where one draws)")
      ->check(CLI::IsMember({"best", "processor", "card"}));
}

void AddSheet(CLI::App& app, Options& options) {
  auto* const sheet = app.add_option(
      "--sheet", options.sheet,
      "Draws a contact sheet (aus, emotions, visemes or identities) to --out and ends");
  app.add_option("--out", options.sheet_file, "The sheet's file, .png or .bmp")->needs(sheet);
  app.add_flag_callback(
         "--no-labels", [&options] { options.labels = false; }, "Draws the sheet without names")
      ->needs(sheet);
}

/// Returns the face of --head. REQUIRES: --head was given.
NamedFace GivenFace(const Options& options) {
  std::string name = std::filesystem::path(options.head_path).stem().string();
  for (char& c : name) {
    if (!IsFaceName(std::string_view(&c, 1))) c = '_';
  }
  return {name.empty() ? "head" : name,
          [file = options.head_path, tables = options.module.tables,
           cache = HeadCache(options.cache_folder, options.module.log)] {
            return cache.HeadOfFile(file, tables);
          }};
}

void FindFaces(Options& options) {
  const OriginalConfig& config = options.module.config;
  auto [faces, left_out] = OriginalFaces(config.faces, config.shared, options.module.tables);
  for (const std::string& what : left_out) options.module.log("notice: " + what);
  options.faces = std::move(faces);
  if (options.head_path.empty()) return;
  if (!std::filesystem::is_regular_file(options.head_path)) {
    throw std::runtime_error("--head: there is no file '" + options.head_path + "'");
  }
  options.faces.insert(options.faces.begin(), GivenFace(options));
}

void ChooseSize(Options& options) {
  const OriginalConfig& config = options.module.config;
  GlFaceView::Options& view = options.view;
  view.width = config.width.value_or(view.width);
  view.height = config.height.value_or(view.height);
  if (options.size_pair) std::tie(view.width, view.height) = *options.size_pair;
  char end = '\0';
  if (!options.size_text.empty() &&
      std::sscanf(options.size_text.c_str(), "%dx%d%c", &view.width, &view.height, &end) != 2) {
    throw std::runtime_error("--size " + options.size_text + " is not WIDTHxHEIGHT, as 640x480");
  }
  const auto fits = [](int side) { return side >= 16 && side <= kMaxImageSide; };
  if (!fits(view.width) || !fits(view.height)) {
    throw std::runtime_error("the view must be 16 to " + std::to_string(kMaxImageSide) +
                             " pixels wide and high");
  }
  if (!view.position && config.x && config.y) view.position = {*config.x, *config.y};
}

}  // namespace

std::vector<char*> NamePositionOption(int argc, char** argv) {
  static char position[] = "--position";
  std::vector<char*> words(argv, argv + argc);
  for (std::size_t i = 1; i + 2 < words.size(); ++i) {
    if (std::string_view(words[i]) == "-p" && IsNumber(words[i + 1]) && IsNumber(words[i + 2])) {
      words[i] = position;
    }
  }
  return words;
}

void AddOptions(CLI::App& app, Options& options) {
  TellRenderer(app, options);
  AddDrawing(app, options.view);
  app.add_option("--size", options.size_text, "Size of the view, WxH (default 640x480)");
  app.add_option_function<std::pair<int, int>>(
         "-s", [&options](const auto& size) { options.size_pair = size; },
         "The same, as the original: -s W H")
      ->type_name("W H");
  app.add_option_function<std::pair<int, int>>(
         "--position", [&options](const auto& place) { options.view.position = place; },
         "Place of the window; -p X Y, too")
      ->type_name("X Y");
  app.add_option("-C", options.config_path, "A configuration file of the original (config.txt)");
  app.add_option_function<std::string>(
      "--tables", [&options](const std::string& path) { options.module.tables = path; },
      "A folder of tables (mouth_shapes.txt, emotions.txt, ...) in place of the built-in");
  app.add_option("--mask", options.module.initial_face,
                 "The face worn at the start (default galatea)");
  app.add_option("--head", options.head_path,
                 "A head from elsewhere, .obj, .glb, .gltf or .vrm, worn at the start");
  app.add_option(
         "--cache", options.cache_folder,
         "A folder that keeps the heads of files once they are baked, so that they start at "
         "once the next time")
      ->envname("GALATEA_HEAD_CACHE");
  app.add_option("--export", options.export_file,
                 "Writes the face worn at the start with ARKit's shapes as .glb and ends");
  app.add_flag("--describe", options.describe,
               "Tells what the face worn at the start is made of, and ends");
  app.add_option(
      "--background", options.module.background,
      "What is behind the agent at the start, as slot Background: plain (default), studio, "
      "a picture, #rrggbb or transparent");
  app.add_option("--life", options.module.life,
                 "What the face does by itself from the start: OFF (default), CALM, LIVELY, ...");
  AddSheet(app, options);
  app.add_option("--seed", options.module.seed, "Of what the face does by itself (default 1)");
}

void ResolveOptions(Options& options) {
  const TableFolder& tables = options.module.tables;
  for (const std::string& notice : vm::OrThrow(CheckTables(tables))) {
    options.module.log("notice: " + notice);
  }
  if (!options.config_path.empty()) {
    options.module.config = vm::OrThrow(OriginalConfig::Read(options.config_path));
    options.module.config.expressions =
        LooksOfExpressions(options.module.config.shared, options.module.log);
  }
  options.view.tables = tables;
  options.view.log = options.module.log;
  ChooseSize(options);
  FindFaces(options);
}

}  // namespace fsm
