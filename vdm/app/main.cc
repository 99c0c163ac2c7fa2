// The module of voice-driven movement: options, sources of sound, and the module over them; or the
// track of one recording.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "sound/sound_file.h"
#include "sound/sources.h"
#include "vdm/app/track_print.h"
#include "vdm/core/movement_module.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/runtime/asio_scheduler.h"
#include "vm_protocol/runtime/module_main.h"

namespace {

constexpr std::size_t kMaxNetBytes = std::size_t{4} << 20;

struct Options {
  std::string file, print = "csv", net_file, speakers_folder;
  bool live = false, cepstra = false, mel = false;
  std::optional<vdm::MouthNet> net;
};

template <typename T>
T OrThrow(vm::Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

const vdm::MouthNet& NetOf(const Options& options, vdm::FeatureKind features) {
  const bool own = options.net && options.net->features == features;
  return own ? *options.net : vdm::ShippedNet(features);
}

int BeforeStart(Options& options) {
  if (!options.net_file.empty()) {
    options.net = OrThrow(vdm::ParseMouthNet(
        options.net_file, OrThrow(vm::ReadTextFile(options.net_file, kMaxNetBytes))));
  }
  if (options.file.empty()) return -1;
  const auto kind = options.net       ? options.net->features
                    : options.cepstra ? vdm::FeatureKind::kCepstra
                    : options.mel || !vdm::CanMakeFeatures(vdm::FeatureKind::kPhones)
                        ? vdm::FeatureKind::kMel
                        : vdm::FeatureKind::kPhones;
  OrThrow(vdm::CanMakeFeatures(kind));
  const auto samples = OrThrow(sound::ReadSound(options.file));
  std::cout << vdm::PrintTrack(NetOf(options, kind), samples, options.print) << std::flush;
  return std::cout ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  const bool stdin_free = std::any_of(argv + 1, argv + argc, [](std::string_view word) {
    return word.starts_with("--listen") || word.starts_with("--connect");
  });
  return vm::RunModule(
      argc, argv,
      {.name = "vdm",
       .description = "Voice-driven movement: a face that moves with any voice",
       .module_name = "VDM",
       .virtual_by_default = true,
       .add_options =
           [&](CLI::App& app) {
             app.add_option("file", options.file,
                            "A recording: its track is printed, and that is all");
             app.add_option("--print", options.print, "How: csv, or lines for fsm (docs/vdm.md)")
                 ->check(CLI::IsMember({"csv", "lines"}));
             app.add_flag("--cepstra", options.cepstra,
                          "The track by the small network of the papers");
             app.add_flag("--mel", options.mel,
                          "The track by mel bands alone, as where pocketsphinx-en-us is missing");
             app.add_option("--net", options.net_file,
                            "A network made by vdm_train in place of the program's own");
             app.add_option("--speakers", options.speakers_folder,
                            "A folder in which learned speakers are kept (slot Speaker)")
                 ->check(CLI::ExistingDirectory);
             app.add_flag("--live", options.live,
                          "Sound comes from a microphone or pipe: the real clock");
           },
       .before_start = [&] { return BeforeStart(options); },
       .needs_real_clock = [&] { return options.live; },
       .make =
           [&](vm::Scheduler& scheduler, boost::asio::io_context& io) {
             auto& clock = dynamic_cast<vm::ClockScheduler&>(scheduler);
             return std::make_unique<vdm::MovementModule>(
                 scheduler, vdm::MovementModule::Options{
                                .module_version = "Galatea VDM " GALATEA_VERSION,
                                .open_source = [&](const std::string& name)
                                    -> vm::Result<std::unique_ptr<sound::AudioSource>> {
                                  if (name.ends_with(":-") && !stdin_free) {
                                    return vm::Fail(
                                        vm::Errc::kUnavailable,
                                        "standard input brings the commands; run with --listen "
                                        "or --connect");
                                  }
                                  return sound::OpenSource(name, clock, io, clock.real());
                                },
                                .clock_is_shared = [&clock] { return !clock.real(); },
                                .phones = vdm::CanMakeFeatures(vdm::FeatureKind::kPhones)
                                              ? &NetOf(options, vdm::FeatureKind::kPhones)
                                              : nullptr,
                                .mel = &NetOf(options, vdm::FeatureKind::kMel),
                                .cepstra = &NetOf(options, vdm::FeatureKind::kCepstra),
                                .speakers_folder = options.speakers_folder});
           }});
}
