// Prints what a face in a film does, frame by frame, as MediaPipe's networks see it.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include "face_fit/watch/face_watch.h"
#include "vm_protocol/core/or_throw.h"

namespace {

using facefit::FaceMeasures;

struct Options {
  std::string size, networks;
  double rate = 30;
  bool points = false;
};

/// Returns a frame of the size "WIDTHxHEIGHT".
fsm::Image FrameOfSize(const std::string& text) {
  int width = 0, height = 0, end = 0;
  const int read = std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &end);
  if (read != 2 || text[static_cast<std::size_t>(end)] != '\0' || width < 16 || height < 16 ||
      width > fsm::kMaxImageSide || height > fsm::kMaxImageSide) {
    throw std::runtime_error("--size '" + text + "': expected WIDTHxHEIGHT, each 16 to " +
                             std::to_string(fsm::kMaxImageSide));
  }
  return fsm::FilledImage(width, height);
}

/// A column of the CSV; the time comes before the first.
struct Column {
  const char* name;
  float (*get)(const FaceMeasures&);
};
constexpr Column kColumns[] = {
    {"certainty", [](const FaceMeasures& m) { return m.certainty; }},
    {"gap", [](const FaceMeasures& m) { return m.gap_mm; }},
    {"width", [](const FaceMeasures& m) { return m.width_mm; }},
    {"jaw", [](const FaceMeasures& m) { return m.jaw_mm; }},
    {"corner_up_right", [](const FaceMeasures& m) { return m.corner_up_mm.right; }},
    {"corner_up_left", [](const FaceMeasures& m) { return m.corner_up_mm.left; }},
    {"eye_right", [](const FaceMeasures& m) { return m.eye_mm.right; }},
    {"eye_left", [](const FaceMeasures& m) { return m.eye_mm.left; }},
    {"brow_inner_right", [](const FaceMeasures& m) { return m.brow_inner_mm.right; }},
    {"brow_inner_left", [](const FaceMeasures& m) { return m.brow_inner_mm.left; }},
    {"brow_outer_right", [](const FaceMeasures& m) { return m.brow_outer_mm.right; }},
    {"brow_outer_left", [](const FaceMeasures& m) { return m.brow_outer_mm.left; }},
    {"turn_down", [](const FaceMeasures& m) { return m.turn_deg.x; }},
    {"turn_left", [](const FaceMeasures& m) { return m.turn_deg.y; }},
    {"tilt_left", [](const FaceMeasures& m) { return m.turn_deg.z; }},
    {"gaze_across", [](const FaceMeasures& m) { return m.gaze.x; }},
    {"gaze_up", [](const FaceMeasures& m) { return m.gaze.y; }}};

void PrintRow(long number, double rate, const std::optional<FaceMeasures>& measures) {
  std::cout << fmt::format("{:.1f}", 1000.0 * static_cast<double>(number) / rate);
  if (!measures) {
    std::cout << ",0" << std::string(std::size(kColumns) - 1, ',') << "\n";
    return;
  }
  for (const Column& column : kColumns) std::cout << fmt::format(",{:.3f}", column.get(*measures));
  std::cout << "\n";
}

/// Prints x and y of the 468 points, then of the right and the left iris, five each.
void PrintPoints(const std::optional<facefit::AttentiveFace>& face) {
  std::string row;
  const auto add = [&row](float x, float y) {
    row += fmt::format("{}{:.2f},{:.2f}", row.empty() ? "" : ",", x, y);
  };
  if (face) {
    for (const glm::vec3& p : face->face.points) add(p.x, p.y);
    for (const auto& iris : face->iris.InOrder()) {
      for (const glm::vec2& p : iris) add(p.x, p.y);
    }
  }
  std::cout << row << "\n";
}

void Watch(const Options& options) {
  fsm::Image frame = FrameOfSize(options.size);
  facefit::FaceNetworks networks = vm::OrThrow(facefit::FaceNetworks::Load(options.networks));
  facefit::AttentionNetwork attention =
      vm::OrThrow(facefit::AttentionNetwork::Load(options.networks));
  facefit::FaceWatch watch(networks, attention);
  if (!options.points) {
    std::cout << "ms";
    for (const Column& column : kColumns) std::cout << "," << column.name;
    std::cout << "\n";
  }
  for (long number = 0;; ++number) {
    const std::size_t got = std::fread(frame.rgba.data(), 1, frame.rgba.size(), stdin);
    if (got == 0 && number > 0) return;
    if (got != frame.rgba.size()) {
      throw std::runtime_error(
          fmt::format("standard input ends within frame {}: it has {} of {} bytes ({} RGBA)",
                      number, got, frame.rgba.size(), options.size));
    }
    const auto measures = watch.MeasureNext(frame);
    if (options.points) {
      PrintPoints(watch.last());
    } else {
      PrintRow(number, options.rate, measures);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Reads frames (RGBA, 4 bytes a pixel) from standard input and prints what their face does, "
      "CSV.\n"
      "  ffmpeg -v error -i film.mp4 -f rawvideo -pix_fmt rgba - | face_watch --size 480x480\n"
      "Lengths are mm on a face whose outer corners of the eyes lie 90 mm apart, turned back to "
      "how\n"
      "it is held in the first frame. Where no face is seen, certainty is 0 and the rest is "
      "empty.");
  app.set_version_flag("--version", "face_watch (Galatea) " GALATEA_VERSION);
  app.add_option("--size", options.size, "WIDTHxHEIGHT of a frame")->required();
  app.add_option("--rate", options.rate, "Frames a second")->check(CLI::Range(1.0, 1000.0));
  app.add_flag(
      "--points", options.points,
      "Print instead where the network's 468 points and 5 of each iris lie: x,y in pixels");
  app.add_option("--networks", options.networks,
                 "Where scripts/face_networks.sh put the networks (default: where it does)");
  CLI11_PARSE(app, argc, argv);
  try {
    Watch(options);
  } catch (const std::exception& error) {
    std::cerr << "face_watch: " << error.what() << std::endl;
    return 1;
  }
}
