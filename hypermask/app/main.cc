// Projects the agent's face onto a mask that moves: as a module before a camera and a projector, or
// on the simulated stage; and makes the table of errors and the demonstration film.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <iostream>
#include <string>
#include <vector>

#include "hypermask/live/mask_module.h"
#include "hypermask/live/real_rig.h"
#include "hypermask/sim/film.h"
#include "hypermask/sim/sim_rig.h"
#include "hypermask/sim/trial.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/runtime/module_main.h"

namespace {

using namespace hypermask;

struct Wanted {
  StageFilm film{};
  std::vector<std::string> scenes{"sway", "walk", "shake", "turn"};
  bool errors = false;
  std::uint32_t seed = 11;
  double seconds = 30, field = 33;
};

void AddOptions(CLI::App& app, Wanted& wanted) {
  app.add_flag("--errors", wanted.errors,
               "Prints how far the face lands from where it should on the simulated stage, and "
               "that is all");
  app.add_option("--film", wanted.film.out,
                 "Makes a film of the simulated stage (.mp4, .mov, .webm), and that is all");
  app.add_option("--face", wanted.film.face,
                 "The face of the film: a film or a folder of pictures");
  app.add_option("--sound", wanted.film.sound, "The sound of the film, a .wav");
  app.add_option(
      "--scene", wanted.scenes,
      "Scenes of the film: \"MOVEMENT [delay=MS] [seed=N] [rate=HZ] [cover=SECONDS]\", a "
      "movement is one of still, places, sway, walk, shake, turn");
  app.add_option("--seconds", wanted.seconds,
                 "How long each movement of --errors (30) and each scene of --film (6) lasts")
      ->check(CLI::Range(2.0, 600.0));
  app.add_option("--seed", wanted.seed,
                 "What the movements of --errors are made by chance from (11)");
  app.add_option(
         "--field", wanted.field,
         "Degrees --errors believes the camera to see from below to above (33, which is so)")
      ->check(CLI::Range(5.0, 120.0));
}

int RunAlone(Wanted& wanted, bool seconds_given) {
  if (wanted.errors) {
    std::cout << ErrorTable(wanted.seed, wanted.seconds, wanted.field);
    return 0;
  }
  if (wanted.film.out.empty()) return -1;
  if (wanted.film.face.empty()) throw std::runtime_error("--film needs a --face");
  if (wanted.film.face == wanted.film.out) {
    throw std::runtime_error("'" + wanted.film.out +
                             "' is the face's film, which is not overwritten");
  }
  for (const std::string& scene : wanted.scenes) {
    wanted.film.scenes.push_back(vm::OrThrow(SimSettings::Parse(scene)));
  }
  if (seconds_given) wanted.film.scene_seconds = wanted.seconds;
  MakeStageFilm(wanted.film);
  return 0;
}

vm::Result<std::unique_ptr<Rig>> OpenRig(boost::asio::io_context& io, vm::Scheduler& scheduler,
                                         bool stdin_free, const MaskModule::RigWish& wish,
                                         Rig::Events events) {
  constexpr std::string_view kSimulated = "sim:";
  if (wish.input.starts_with(kSimulated)) {
    auto settings = SimSettings::Parse(wish.input.substr(kSimulated.size()));
    if (!settings) return std::unexpected(settings.error());
    return std::make_unique<SimRig>(scheduler, wish.layout, *settings, std::move(events));
  }
  if (wish.input == "-" && !stdin_free) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "standard input brings the commands; run with --listen or --connect");
  }
  return RealRig::Open(io, scheduler, {.camera = wish.input, .screen = wish.screen},
                       std::move(events));
}

}  // namespace

int main(int argc, char** argv) {
  Wanted wanted;
  CLI::App* options = nullptr;
  const bool stdin_free = std::any_of(argv + 1, argv + argc, [](std::string_view word) {
    return word.starts_with("--listen") || word.starts_with("--connect");
  });
  return vm::RunModule(
      argc, argv,
      {.name = "hypermask",
       .description =
           "Projects a talking face onto a mask that moves: follows its markers in a camera's\n"
           "picture, foretells where it will be, and draws the face there (docs/hypermask.md).\n"
           "  hypermask --errors",
       .module_name = "MASK",
       .virtual_by_default = false,
       .add_options =
           [&](CLI::App& app) {
             options = &app;
             AddOptions(app, wanted);
           },
       .before_start = [&] { return RunAlone(wanted, options->count("--seconds") > 0); },
       .make =
           [&](vm::Scheduler& scheduler, boost::asio::io_context& io) {
             return std::make_unique<MaskModule>(
                 scheduler,
                 MaskModule::Options{.module_version = "Galatea hypermask " GALATEA_VERSION,
                                     .open =
                                         [&io, &scheduler, stdin_free](
                                             const MaskModule::RigWish& wish, Rig::Events events) {
                                           return OpenRig(io, scheduler, stdin_free, wish,
                                                          std::move(events));
                                         },
                                     .io = &io});
           }});
}
