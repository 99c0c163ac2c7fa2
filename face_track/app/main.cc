// Follows a face: through a film, whose track is printed; or as a module, before a camera, where it
// moves the agent's.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <map>
#include <stdexcept>
#include <string>

#include "face_fit/find/network/attention_points.h"
#include "face_fit/find/network/face_networks.h"
#include "face_track/app/film_track.h"
#include "face_track/live/track_module.h"
#include "vm_protocol/runtime/module_main.h"

namespace {

using namespace facetrack;

void AddOptions(CLI::App& app, FilmTrack& wanted) {
  app.add_option("film", wanted.film,
                 "A film, a folder of pictures, - for standard input, camera, v4l2:DEVICE or "
                 "ffmpeg:WORDS: its track is printed, and that is all");
  app.add_option("--out", wanted.out, "Where the track goes (default: standard output)");
  app.add_option("--plot", wanted.plot, "Draws the track, too: a file .svg");
  static const std::map<std::string, FacePrint::Format> formats{
      {"csv", FacePrint::Format::kCsv},
      {"jsonl", FacePrint::Format::kJsonLines},
      {"arkit", FacePrint::Format::kArkit}};
  app.add_option("--format", wanted.format, "csv, jsonl or arkit")
      ->transform(CLI::CheckedTransformer(formats))
      ->option_text("TEXT:{csv,jsonl,arkit}");
  app.add_flag("--landmarks", wanted.extras.points,
               "The 470 points, too: mm in the head's frame, the face's motion in them");
  app.add_flag("--mouth", wanted.extras.mouth,
               "What the mouth does, too, in mouth parameters: seal, tongue, m1 to m17, as vdm's");
  app.add_option("--field", wanted.tracker.field_degrees,
                 "Degrees the camera sees from below to above (40)")
      ->check(CLI::Range(5.0, 120.0));
  app.add_option("--settle", wanted.tracker.settle_ms,
                 "How many ms of a person are taken for its rest (1000)")
      ->check(CLI::Range(0.0, 4000.0));
  app.add_option("--smooth", wanted.tracker.smooth, "How much is smoothed: 0 not at all, 1 usual")
      ->check(CLI::Range(0.0, 20.0));
  app.add_option("--which", wanted.tracker.which, "Which of several faces: 1 = the largest")
      ->check(CLI::Range(1, 10));
  app.add_flag("--careful", wanted.tracker.careful,
               "The network looks thrice at each picture: nearer on the mean, in twice the time");
  app.add_option("--rate", wanted.rate, "Pictures a second of a folder (25)")
      ->check(CLI::Range(0.1, 1000.0));
  app.add_option("--networks", wanted.networks,
                 "Where scripts/face_networks.sh put the networks (default: where it does)");
  auto* const lesson = app.add_option(
      "--learn-units", wanted.lesson,
      "Prints how this person's face moves, in place of the track: a table of when the film shows "
      "which unit, rows 'show FROM TO UNIT [DOSE]' (seconds)");
  app.add_option("--person", wanted.person,
                 "How the face that is followed moves: what --learn-units printed")
      ->excludes(lesson);
  app.add_flag("--quiet", wanted.quiet, "Nothing on standard error but errors");
}

/// A tracker of what `name` is; `stdin_free`: standard input brings no commands. `face` outlives
/// it.
vm::Result<std::unique_ptr<LiveTracker>> Open(boost::asio::io_context& io, const FilmTrack& wanted,
                                              const SeenFace& face, bool stdin_free,
                                              const std::string& name,
                                              const Tracker::Settings& settings,
                                              LiveTracker::Events events) {
  if (name == "-" && !stdin_free) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "standard input brings the commands; run with --listen or --connect");
  }
  auto networks = facefit::FaceNetworks::Load(wanted.networks);
  if (!networks) return std::unexpected(networks.error());
  auto attention = facefit::AttentionNetwork::Load(wanted.networks);
  if (!attention) return std::unexpected(attention.error());
  auto source = OpenPictures(name, wanted.rate);
  if (!source) return std::unexpected(source.error());
  return std::make_unique<LiveTracker>(
      io, std::move(*source), IsLive(name),
      std::make_unique<LiveTracker::Looker>(std::move(*networks), std::move(*attention), face,
                                            settings),
      std::move(events));
}

}  // namespace

int main(int argc, char** argv) {
  FilmTrack wanted;
  SeenFace face;  // of the module
  const bool stdin_free = std::any_of(argv + 1, argv + argc, [](std::string_view word) {
    return word.starts_with("--listen") || word.starts_with("--connect");
  });
  return vm::RunModule(
      argc, argv,
      {.name = "face_track",
       .description =
           "Film in, face out: follows a face and tells how the head is held, units of\n"
           "FACS, lids, gaze and jaw; as a module it moves the agent (docs/tracking.md).\n"
           "  face_track film.mp4 --out track.csv",
       .module_name = "TRACK",
       .add_options = [&](CLI::App& app) { AddOptions(app, wanted); },
       .before_start =
           [&] {
             if (wanted.film.empty()) {
               if (!wanted.lesson.empty()) throw std::runtime_error("--learn-units needs a film");
               face = FaceToFollow(wanted.person);
               return -1;
             }
             PrintFilmTrack(wanted);
             return 0;
           },
       .needs_real_clock = [] { return true; },
       .make =
           [&](vm::Scheduler& scheduler, boost::asio::io_context& io) {
             return std::make_unique<TrackModule>(
                 scheduler,
                 TrackModule::Options{
                     .module_version = "Galatea face_track " GALATEA_VERSION,
                     .tracker = wanted.tracker,
                     .open = [&io, &wanted, &face, stdin_free](const std::string& name,
                                                               const Tracker::Settings& settings,
                                                               LiveTracker::Events events) {
                       return Open(io, wanted, face, stdin_free, name, settings, std::move(events));
                     }});
           }});
}
