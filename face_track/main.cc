// Follows a face through a film and prints what it does, picture by picture.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include "face_track/film/picture_source.h"
#include "face_track/follow/tracker.h"
#include "face_track/print/face_print.h"
#include "vm_protocol/core/or_throw.h"

namespace {

using namespace facetrack;

struct Options {
  std::string film, out, format = "csv", networks;
  double rate = 25;
  bool points = false, quiet = false;
  Tracker::Settings tracker;
};

/// Says how far it is, at a terminal in one line that changes, else every ten seconds.
class Progress {
 public:
  Progress(bool quiet, std::optional<double> length_ms) : quiet_(quiet), length_ms_(length_ms) {}
  void At(std::size_t pictures, double ms) {
    const auto now = Clock::now();
    const bool terminal = isatty(2) != 0;
    const std::chrono::duration<double> since = now - shown_;
    if (quiet_ || since.count() < (terminal ? 0.5 : 10)) return;
    shown_ = now;
    const std::chrono::duration<double> all = now - begun_;
    std::string text = fmt::format("face_track: {} pictures, {:.1f} s", pictures, ms / 1000);
    if (length_ms_ && *length_ms_ > 0) text += fmt::format(" of {:.1f}", *length_ms_ / 1000);
    text += fmt::format(", {:.1f} pictures a second", static_cast<double>(pictures) / all.count());
    std::cerr << (terminal ? "\r\033[K" + text : text + "\n") << std::flush;
    open_line_ = terminal;
  }
  ~Progress() {
    if (open_line_) std::cerr << "\r\033[K" << std::flush;
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_, open_line_ = false;
  std::optional<double> length_ms_;
  Clock::time_point begun_ = Clock::now(), shown_ = begun_;
};

FacePrint::Format FormatOf(const std::string& name) {
  return name == "jsonl"   ? FacePrint::Format::kJsonLines
         : name == "arkit" ? FacePrint::Format::kArkit
                           : FacePrint::Format::kCsv;
}

void Follow(const Options& options) {
  auto networks = vm::OrThrow(facefit::FaceNetworks::Load(options.networks));
  auto attention = vm::OrThrow(facefit::LoadAttentionLandmarks(options.networks));
  const SeenFace& face = SeenFace::Shipped();
  Tracker tracker(networks, attention, face, options.tracker);
  const FacePrint print(FormatOf(options.format), options.points, face);
  const auto source = vm::OrThrow(OpenPictures(options.film, options.rate));
  TimedPicture picture;
  std::size_t pictures = 0, faces = 0;
  std::FILE* out = stdout;
  const auto write = [&](const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), out) != text.size() ||
        (IsLive(options.film) && std::fflush(out) != 0)) {
      throw std::runtime_error("the track cannot be written to '" + options.out + "'");
    }
  };
  const auto write_all = [&](const std::vector<FaceLine>& lines) {
    for (const FaceLine& line : lines) {
      faces += line.person != 0 ? 1 : 0;
      write(print.Line(line));
    }
  };
  auto more = source->Next(picture);
  if (!more) throw std::runtime_error(more.error().text);
  if (!options.out.empty()) out = std::fopen(options.out.c_str(), "w");
  if (!out) throw std::runtime_error("cannot write '" + options.out + "'");
  write(print.Header());
  Progress progress(options.quiet, source->length_ms());
  for (; more && *more; more = source->Next(picture)) {
    write_all(tracker.Look(picture.picture, picture.ms));
    progress.At(++pictures, picture.ms);
  }
  write_all(tracker.Finish());
  if (std::fflush(out) != 0 || (out != stdout && std::fclose(out) != 0)) {
    throw std::runtime_error("the track cannot be written to '" + options.out + "'");
  }
  if (!more) throw std::runtime_error(more.error().text);
  if (faces == 0) {
    throw std::runtime_error(
        fmt::format("'{}': no face is seen in any of its {} pictures", options.film, pictures));
  }
  if (!options.quiet) {
    std::cerr << fmt::format("face_track: a face in {} of {} pictures\n", faces, pictures);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Follows the largest face through a film and prints what it does, a line a picture: how the\n"
      "head is held, units of FACS, lids, gaze and jaw (docs/tracking.md).\n"
      "  face_track film.mp4 --out track.csv");
  app.add_option("film", options.film,
                 "A film, a folder of pictures, - for standard input, camera, v4l2:DEVICE or "
                 "ffmpeg:WORDS")
      ->required();
  app.add_option("--out", options.out, "Where the track goes (default: standard output)");
  app.add_option("--format", options.format, "csv, jsonl or arkit")
      ->check(CLI::IsMember({"csv", "jsonl", "arkit"}));
  app.add_flag("--landmarks", options.points,
               "The 470 points, too: mm in the head's frame, the face's motion in them");
  app.add_option("--field", options.tracker.field_degrees,
                 "Degrees the camera sees from below to above (40)")
      ->check(CLI::Range(5.0, 120.0));
  app.add_option("--settle", options.tracker.settle_ms,
                 "How many ms of a person are taken for its rest (1000)")
      ->check(CLI::Range(0.0, 4000.0));
  app.add_option("--smooth", options.tracker.smooth, "How much is smoothed: 0 not at all, 1 usual")
      ->check(CLI::Range(0.0, 20.0));
  app.add_option("--rate", options.rate, "Pictures a second of a folder (25)")
      ->check(CLI::Range(0.1, 1000.0));
  app.add_option("--networks", options.networks,
                 "Where scripts/face_networks.sh put the networks (default: where it does)");
  app.add_flag("--quiet", options.quiet, "Nothing on standard error but errors");
  CLI11_PARSE(app, argc, argv);
  try {
    Follow(options);
  } catch (const std::exception& error) {
    std::cerr << "face_track: " << error.what() << std::endl;
    return 1;
  }
}
