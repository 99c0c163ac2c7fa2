// What a frame of the face costs, with software OpenGL off screen. Prints one line for each figure:
//
//   draw_bench [--frames N] [--runs R] [--size WxH] [--face NAME] [--config FILE]
//              [--context osmesa|egl] [--rig best|processor|card] [--faces N] [--only WORDS]
//              [--form-error PIXELS]
//
// --face: another head, one made from a photo for example, measured beside the built-in one;
// --config: a configuration of the original (config.txt), whose first face is measured, too;
// --context and --rig: as of fsm; --faces: how many are drawn in one picture at 256 x 256 each,
// default 16; --only: just the figures whose names contain WORDS; --form-error: in place of that of
// appearance.txt, 0 draws all triangles.
//
// Every figure is the best of R runs (default 5) of N frames (default 120), because other work on
// the machine only ever adds to it. "moving" frames change expression, mouth, lids, gaze and head
// turn from frame to frame; wall time runs from the state to the pixels read; "in a film" two more
// are drawn before a picture is read. "still" frames draw the same vertices again: the bare cost of
// the triangles.

#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <functional>
#include <future>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/base/large_pages.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/faces/original_config.h"
#include "fsm/faces/original_faces.h"
#include "fsm/head/make_head.h"
#include "fsm/render/appearance.h"
#include "fsm/render/renderer.h"
#include "fsm/rig/head.h"
#include "vm_protocol/core/or_throw.h"

extern "C" char** environ;

namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  int frames = 120;
  int runs = 5;
  int width = 640;
  int height = 480;
  int faces = 16;
  float form_error = -1;  // pixels; less than 0: as the table has it
  fsm::OffScreenDriver context = fsm::OffScreenDriver::kOsMesa;
  fsm::RigDevice rig = fsm::RigDevice::kBest;
  std::string face, config, only;
};

struct Cost {
  double wall_ms = 1e9;
  double cpu_ms = 1e9;
};

double CpuMs() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_usec) / 1e3;
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

/// Wall and CPU milliseconds of one call, the least of all runs.
Cost Measure(const Options& options, const std::function<void(int)>& frame) {
  Cost best;
  for (int run = 0; run < options.runs; ++run) {
    const auto start = Clock::now();
    const double cpu = CpuMs();
    for (int i = 0; i < options.frames; ++i) frame(i);
    const std::chrono::duration<double, std::milli> wall = Clock::now() - start;
    best.wall_ms = std::min(best.wall_ms, wall.count() / options.frames);
    best.cpu_ms = std::min(best.cpu_ms, (CpuMs() - cpu) / options.frames);
  }
  return best;
}

/// A face that does everything at once: talks, smiles, blinks, looks about and turns.
fsm::FaceState Moving(int frame) {
  fsm::FaceState state;
  const auto wave = [frame](float period, float phase) {
    return 0.5F + 0.5F * std::sin(static_cast<float>(frame) * 6.2832F / period + phase);
  };
  for (auto* side : {&state.au.left, &state.au.right}) {
    for (const std::size_t unit : {1U, 2U, 4U, 6U, 9U, 12U, 15U, 26U}) {
      (*side)[unit] = 0.5F * wave(60, static_cast<float>(unit));
    }
  }
  for (std::size_t i = 0; i < fsm::kMouthParameters; ++i) {
    state.mouth[i] = wave(17, static_cast<float>(i)) - 0.3F;
  }
  state.mouth[fsm::kJawY] = 7 * wave(11, 0);
  state.blink.left = state.blink.right = wave(90, 0) > 0.95F ? 1.0F : 0.0F;
  state.gaze.left = state.gaze.right = {-5 * wave(45, 1), 16 * wave(70, 2) - 8};
  state.head_rotation = {6 * wave(50, 0) - 3, 16 * wave(80, 1) - 8, 4 * wave(66, 2) - 2};
  return state;
}

/// Measures and prints one figure, if it is asked for.
void Print(const Options& options, std::string_view name, const std::function<void(int)>& frame) {
  if (name.find(options.only) == name.npos) return;
  const Cost cost = Measure(options, frame);
  std::printf("%-34s %8.2f ms wall %8.2f ms CPU %8.1f a second\n", std::string(name).c_str(),
              cost.wall_ms, cost.cpu_ms, 1e3 / cost.wall_ms);
  std::fflush(stdout);
}

/// Process start to pixels, in a process of its own: this program with --first-frame.
double FirstFrameMs(char** argv, const Options& options) {
  double best = 1e9;
  std::string size = std::to_string(options.width) + "x" + std::to_string(options.height);
  char flag[] = "--first-frame";
  char size_flag[] = "--size";
  char* child_argv[] = {argv[0], flag, size_flag, size.data(), nullptr};
  for (int run = 0; run < options.runs; ++run) {
    const auto start = Clock::now();
    pid_t child = 0;
    int status = 0;
    if (posix_spawn(&child, "/proc/self/exe", nullptr, nullptr, child_argv, environ) != 0) return 0;
    waitpid(child, &status, 0);
    if (status != 0) return 0;
    const std::chrono::duration<double, std::milli> wall = Clock::now() - start;
    best = std::min(best, wall.count());
  }
  return best;
}

void PrintMemory() {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("VmHWM") || line.starts_with("VmRSS")) std::printf("%s\n", line.c_str());
  }
}

bool ReadOptions(int argc, char** argv, Options& options, bool& first_frame) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const char* value = i + 1 < argc ? argv[i + 1] : nullptr;
    if (word == "--first-frame") {
      first_frame = true;
      continue;
    }
    if (!value) return false;
    ++i;
    char end = '\0';
    if (word == "--frames") {
      options.frames = std::atoi(value);
    } else if (word == "--runs") {
      options.runs = std::atoi(value);
    } else if (word == "--face") {
      options.face = value;
    } else if (word == "--config") {
      options.config = value;
    } else if (word == "--only") {
      options.only = value;
    } else if (word == "--form-error") {
      options.form_error = std::strtof(value, nullptr);
    } else if (word == "--faces") {
      options.faces = std::atoi(value);
    } else if (word == "--context") {
      options.context = std::string_view(value) == "egl" ? fsm::OffScreenDriver::kEgl
                                                         : fsm::OffScreenDriver::kOsMesa;
    } else if (word == "--rig") {
      options.rig = std::string_view(value) == "card"        ? fsm::RigDevice::kGpu
                    : std::string_view(value) == "processor" ? fsm::RigDevice::kProcessor
                                                             : fsm::RigDevice::kBest;
    } else if (word != "--size" ||
               std::sscanf(value, "%dx%d%c", &options.width, &options.height, &end) != 2) {
      return false;
    }
  }
  return options.frames > 0 && options.runs > 0 && options.faces > 0;
}

/// Pictures of one head, each read when two more are drawn, as films are made.
void PrintFilm(const char* name, const Options& options, int width, int height,
               fsm::Renderer& renderer, const fsm::Head& head) {
  fsm::Image image;
  fsm::Scene scene;
  std::deque<std::uint64_t> begun;
  renderer.SetViewport({0, 0, width, height});
  Print(options, name, [&](int i) {
    renderer.Draw(head, Moving(i), {}, scene);
    begun.push_back(renderer.BeginRead());
    if (begun.size() <= 2) return;
    renderer.EndRead(begun.front(), image);
    begun.pop_front();
  });
  for (const std::uint64_t frame : begun) renderer.DropRead(frame);
  renderer.SetViewport({});
}

/// `count` people in one picture of rows of `across`, each of this size, as a window would show
/// them. `read`: all of it is brought to memory, else only the last face.
void PrintMany(const std::string& name, const Options& options, int count, int across, int width,
               int height, fsm::Renderer& renderer, const fsm::Head& head, bool read = true) {
  constexpr std::size_t kUnderWay = 8;  // frames that are read while others are drawn
  fsm::Image image;
  const fsm::Scene scene;
  std::vector<fsm::FaceState> states(static_cast<std::size_t>(count));
  std::vector<fsm::Pane> panes;
  for (int k = 0; k < count; ++k)
    panes.push_back({&head,
                     &states[static_cast<std::size_t>(k)],
                     &scene,
                     {k % across * width, k / across * height, width, height}});
  std::deque<std::uint64_t> begun;
  const auto end_oldest = [&] {
    renderer.EndRead(begun.front(), image);
    begun.pop_front();
  };
  Print(options, name, [&](int i) {
    for (int k = 0; k < count; ++k) states[static_cast<std::size_t>(k)] = Moving(i + 31 * k);
    renderer.DrawPanes(panes, [&](std::size_t k) {
      if (!read && k + 1 < states.size()) return;
      begun.push_back(renderer.BeginRead());
      if (begun.size() > kUnderWay) end_oldest();
    });
    while (!begun.empty()) end_oldest();
  });
  PrintMemory();
}

/// The head of --face in the size asked for, the portrait of --config at 512 x 512.
void PrintOthers(const Options& options, fsm::Renderer& renderer) {
  if (!options.face.empty()) {
    const auto head = fsm::MakeHeadOfName(options.face);
    PrintFilm(options.face.c_str(), options, 0, 0, renderer, *head);
  }
  if (options.config.empty()) return;
  const auto config = vm::OrThrow(fsm::OriginalConfig::Read(options.config));
  const auto faces = fsm::OriginalFaces(config.faces, config.shared, {}).faces;
  if (faces.empty()) throw std::runtime_error(options.config + " has no face");
  PrintFilm("portrait at 512 x 512 in a film", options, 512, 512, renderer, *faces.front().make());
}

/// As the program draws, or the option.
float FormError(const Options& options) {
  return options.form_error >= 0 ? options.form_error : fsm::Appearance::BuiltIn().form_error;
}

void MeasureAll(char** argv, const Options& options) {
  std::printf("%s\n", fsm::DescribeOffScreen(options.context).c_str());
  auto context = fsm::RenderContext::MakeHeadless(options.width, options.height, options.context);
  auto renderer = fsm::Renderer::Make(*context, 8, fsm::Appearance::BuiltIn(), options.rig);
  renderer->SetMaxErrorPixels(FormError(options));
  const auto head = fsm::MakeHead("galatea");
  fsm::HeadVertices vertices;
  fsm::Image image;
  const fsm::Scene scene;
  std::printf("%d x %d, 4 samples; head: %zu triangles, %zu vertices\n", options.width,
              options.height, head->surface().indices.size() / 3, head->surface().albedo.size());

  Print(options, "moving face, state to pixels", [&](int i) {
    renderer->Draw(*head, Moving(i), {}, scene);
    renderer->Read(image);
  });
  const fsm::FaceState rest;
  head->Evaluate(rest, vertices);
  Print(options, "still face, vertices to pixels", [&](int) {
    renderer->DrawVertices(*head, vertices, rest.figure, scene);
    renderer->Read(image);
  });
  fsm::FaceState absent;
  absent.figure.enabled = false;
  Print(options, "empty picture", [&](int) {
    renderer->DrawVertices(*head, vertices, absent.figure, scene);
    renderer->Read(image);
  });
  Print(options, "state to vertices", [&](int i) { head->Evaluate(Moving(i), vertices); });
  PrintMemory();
  PrintFilm("moving face in a film", options, 0, 0, *renderer, *head);
  PrintFilm("256 x 256 in a film", options, 256, 256, *renderer, *head);
  PrintMany("four moving faces in one picture", options, 4, 2, options.width / 2,
            options.height / 2, *renderer, *head);
  const std::string faces = std::to_string(options.faces) + " faces";
  PrintMany(faces + " at 256 x 256", options, options.faces, 16, 256, 256, *renderer, *head);
  PrintMany(faces + " drawn, the last one read", options, options.faces, 16, 256, 256, *renderer,
            *head, false);
  PrintOthers(options, *renderer);
  constexpr std::string_view kStart = "process start to first pixels";
  if (kStart.find(options.only) != kStart.npos)
    std::printf("%-34s %8.0f ms wall\n", kStart.data(), FirstFrameMs(argv, options));
}

void DrawFirstFrame(const Options& options) {
  // Like fsm, which makes the head while the driver starts.
  auto made = std::async(std::launch::async, [] { return fsm::MakeHead("galatea"); });
  auto context = fsm::RenderContext::MakeHeadless(options.width, options.height);
  auto renderer = fsm::Renderer::Make(*context);
  renderer->SetMaxErrorPixels(FormError(options));
  const auto head = made.get();
  fsm::HeadVertices vertices;
  fsm::Image image;
  head->Evaluate({}, vertices);
  renderer->DrawVertices(*head, vertices, {}, {});
  renderer->Read(image);
  // The first frame is there; how the process ends is no part of it.
  std::_Exit(image.rgba.empty() ? 1 : 0);
}

}  // namespace

int main(int argc, char** argv) {
  fsm::UseLargePages();
  Options options;
  bool first_frame = false;
  if (!ReadOptions(argc, argv, options, first_frame)) {
    std::fprintf(
        stderr,
        "usage: draw_bench [--frames N] [--runs R] [--size WxH] [--face NAME] [--config FILE]\n"
        "                  [--context osmesa|egl] [--rig best|processor|card] [--faces N]\n"
        "                  [--only WORDS] [--form-error PIXELS]\n");
    return 2;
  }
  try {
    first_frame ? DrawFirstFrame(options) : MeasureAll(argv, options);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "draw_bench: %s\n", error.what());
    return 1;
  }
}
