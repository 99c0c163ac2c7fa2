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
#include "vdm/recording/recording_reader.h"
#include "vdm/triphone/phoneme_file.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/runtime/asio_scheduler.h"
#include "vm_protocol/runtime/module_main.h"

namespace {

constexpr std::size_t kMaxNetBytes = std::size_t{4} << 20;
constexpr std::size_t kMaxTriphoneBytes = std::size_t{8} << 20;

struct Options {
  std::string file, print = "csv", net_file, head_file, emotions_file, speakers_folder;
  std::string phonemes_file, triphones_file;  // for the track of phonemes
  bool live = false, cepstra = false, mel = false, phones = false, head = false, no_words = false;
  std::optional<vdm::MouthNet> net;
  std::optional<vdm::HeadNet> head_net;
  std::optional<vdm::Discriminant> emotions;
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

/// That of words is heard beside the program's own of phones, where both can be. Who brings another
/// of phones wants to see that one, which may know other sounds.
const vdm::MouthNet* WordsNet(const Options& options) {
  const bool other = options.net && options.net->features == vdm::FeatureKind::kPhones;
  return !other && vdm::CanMakeFeatures(vdm::FeatureKind::kWords)
             ? &NetOf(options, vdm::FeatureKind::kWords)
             : nullptr;
}

/// A file given is taken for Head.auto = ON.
const vdm::HeadNet& HeadOf(const Options& options) {
  return options.head_net ? *options.head_net : vdm::ShippedHeadNet(false);
}

template <typename Parse>
auto ReadTable(const std::string& path, Parse parse) {
  return OrThrow(parse(path, OrThrow(vm::ReadTextFile(path, kMaxNetBytes))));
}

/// The track of phonemes whose times are known, in place of a sound's.
std::string TrackOfPhonemes(const Options& options) {
  const auto model = OrThrow(
      vdm::ParseTriphones(options.triphones_file,
                          OrThrow(vm::ReadTextFile(options.triphones_file, kMaxTriphoneBytes))));
  const auto phonemes = OrThrow(vdm::ReadPhonemeFile(options.phonemes_file));
  return OrThrow(vdm::PrintTrack(model, phonemes, options.print));
}

int BeforeStart(Options& options) {
  if (!options.phonemes_file.empty()) {
    std::cout << TrackOfPhonemes(options) << std::flush;
    return std::cout ? 0 : 1;
  }
  if (!options.head_file.empty()) {
    options.head_net = ReadTable(options.head_file, vdm::ParseHeadNet);
  }
  if (!options.emotions_file.empty()) {
    options.emotions = ReadTable(options.emotions_file, vdm::ParseDiscriminant);
    if (options.emotions->features != vdm::PhraseMeter::FeatureNames()) {
      throw std::runtime_error(options.emotions_file +
                               ": has other features than phrases are measured by");
    }
  }
  if (!options.net_file.empty()) {
    options.net = OrThrow(vdm::ParseMouthNet(
        options.net_file, OrThrow(vm::ReadTextFile(options.net_file, kMaxNetBytes))));
  }
  if (options.file.empty()) {
    // Beside the program's own network of phones; of a file it makes the track alone.
    if (options.net && options.net->features == vdm::FeatureKind::kWords &&
        options.net->sounds != vdm::ShippedNet(vdm::FeatureKind::kPhones).sounds) {
      throw std::runtime_error(options.net_file +
                               ": has other sounds than the network of phones it is heard beside");
    }
    return -1;
  }
  const auto kind = options.net       ? options.net->features
                    : options.cepstra ? vdm::FeatureKind::kCepstra
                    : options.mel || !vdm::CanMakeFeatures(vdm::FeatureKind::kPhones)
                        ? vdm::FeatureKind::kMel
                        : vdm::FeatureKind::kPhones;
  OrThrow(vdm::CanMakeFeatures(kind));
  const auto samples = OrThrow(sound::ReadSound(options.file));
  const vdm::MouthNet& mouth = NetOf(options, kind);
  const vdm::HeadNet* head = options.head ? &HeadOf(options) : nullptr;
  if (head && head->sounds != 0 && head->sounds != mouth.sounds.size()) {
    throw std::runtime_error("the head's network knows other sounds than the mouth's");
  }
  // Who asks for a network wants to see that one; prosody is none of words.
  const bool alone = options.net || options.cepstra || options.mel || options.phones ||
                     kind != vdm::FeatureKind::kPhones || options.print == "prosody";
  const vdm::TrackNets nets{mouth, alone ? nullptr : WordsNet(options), head};
  const auto words =
      alone || options.no_words ? vdm::RecordedMouth{} : vdm::ReadWords(samples, "vdm");
  std::cout << vdm::PrintTrack(nets, words, samples, options.print) << std::flush;
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
             app.add_option("--print", options.print,
                            "How: csv, lines for fsm, or prosody (docs/vdm.md)")
                 ->check(CLI::IsMember({"csv", "lines", "prosody"}));
             app.add_flag("--head", options.head, "The track of head and brows too");
             app.add_flag("--cepstra", options.cepstra,
                          "The track by the small network of the papers");
             app.add_flag("--mel", options.mel,
                          "The track by mel bands alone, as where pocketsphinx-en-us is missing");
             app.add_flag("--phones", options.phones,
                          "The track by mel bands and phones, without any words");
             app.add_flag("--no-words", options.no_words,
                          "The track, and recordings on the virtual clock, as live sound moves "
                          "the mouth: without recognising the words first");
             app.add_option("--net", options.net_file,
                            "A network made by vdm_train in place of the program's own");
             auto* phonemes = app.add_option("--phonemes", options.phonemes_file,
                                             "Spoken phonemes as align prints them: their track "
                                             "is printed, and that is all");
             phonemes->needs(app.add_option("--triphones", options.triphones_file,
                                            "Triphones made by vdm_train, for --phonemes")
                                 ->needs(phonemes));
             app.add_option("--head-net", options.head_file,
                            "What moves the head, made by vdm_train --head");
             app.add_option("--emotions", options.emotions_file,
                            "What tells emotions apart, made by vdm_train --emotion");
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
                 scheduler,
                 vdm::MovementModule::Options{
                     .module_version = "Galatea VDM " GALATEA_VERSION,
                     .open_source = [&](const std::string& name)
                         -> vm::Result<std::unique_ptr<sound::AudioSource>> {
                       if (name.ends_with(":-") && !stdin_free) {
                         return vm::Fail(vm::Errc::kUnavailable,
                                         "standard input brings the commands; run with --listen "
                                         "or --connect");
                       }
                       return sound::OpenSource(name, clock, io, clock.real());
                     },
                     .clock_is_shared = [&clock] { return !clock.real(); },
                     .read_words = [&](const std::string& path) -> vdm::RecordedMouth {
                       const auto samples = sound::ReadSound(path);
                       return samples && !options.no_words ? vdm::ReadWords(*samples, "vdm")
                                                           : vdm::RecordedMouth{};
                     },
                     .phones = vdm::CanMakeFeatures(vdm::FeatureKind::kPhones)
                                   ? &NetOf(options, vdm::FeatureKind::kPhones)
                                   : nullptr,
                     .words = WordsNet(options),
                     .mel = &NetOf(options, vdm::FeatureKind::kMel),
                     .cepstra = &NetOf(options, vdm::FeatureKind::kCepstra),
                     .head = &HeadOf(options),
                     .head_by_prosody = &vdm::ShippedHeadNet(true),
                     .emotions = options.emotions ? &*options.emotions : &vdm::ShippedEmotions(),
                     .speakers_folder = options.speakers_folder});
           }});
}
