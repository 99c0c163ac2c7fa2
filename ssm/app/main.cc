// The speech synthesis module: options, the flite engine, a sink, and the voice module over them.

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <boost/asio/post.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>

#include "ssm/app/original_config.h"
#include "ssm/app/real_time_sink.h"
#include "ssm/app/thread_worker.h"
#include "ssm/app/voices_config.h"
#include "ssm/engines/engine_set.h"
#include "ssm/engines/espeak_engine.h"
#include "ssm/flite/flite_engine.h"
#include "ssm/sinks/copying_sink.h"
#include "ssm/sinks/portaudio_sink.h"
#include "ssm/sinks/sink_choice.h"
#include "ssm/voice/voice_module.h"
#include "vm_protocol/core/file_kind.h"
#include "vm_protocol/core/spawn.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/runtime/module_main.h"

namespace {

constexpr const char* kModuleVersion = "Galatea SSM " GALATEA_VERSION;

struct Options {
  std::string sink_text = "auto";
  std::string config_path;
  std::string speaker;
  bool print_version = false;
  std::string voices_path;
  std::string dictionary;
  ssm::SinkChoice sink;
  ssm::OriginalConfig config;
};

void Notice(const std::string& text) { std::cerr << "ssm: " << text << std::endl; }

constexpr std::size_t kMaxFileBytes = 4u << 20;  // configurations, tables of voices

vm::Result<std::string> ReadFile(const std::string& path) {
  return vm::ReadTextFile(path, kMaxFileBytes);
}

std::string ReadFileOrThrow(const std::string& path) {
  auto text = ReadFile(path);
  if (!text) throw std::runtime_error(text.error().text);
  return std::move(*text);
}

/// flite, the voices of the configuration, and espeak-ng for all other languages if it is there.
std::unique_ptr<ssm::SpeechEngine> MakeEngines(const Options& options) {
  std::vector<std::unique_ptr<ssm::SpeechEngine>> engines;
  engines.push_back(ssm::MakeFliteEngine());
  ssm::VoicesConfig config;
  if (!options.voices_path.empty()) {
    const auto folder = std::filesystem::path(options.voices_path).parent_path().string();
    auto parsed = ssm::ParseVoicesConfig(ReadFileOrThrow(options.voices_path),
                                         {.folder = folder.empty() ? "." : folder,
                                          .aligner = vm::ProgramBeside("align"),
                                          .read_file = ReadFile});
    if (!parsed) throw std::runtime_error(options.voices_path + ": " + parsed.error().text);
    config = std::move(*parsed);
  }
  for (auto& engine : config.engines) engines.push_back(std::move(engine));
  if (const std::string helper = vm::ProgramBeside("ssm_espeak");
      access(helper.c_str(), X_OK) == 0) {
    engines.push_back(ssm::MakeEspeakEngine({.helper = helper, .dictionary = options.dictionary}));
  }
  auto set = std::make_unique<ssm::EngineSet>(std::move(engines));
  for (const auto& [language, voice] : config.languages) {
    if (auto chosen = set->ChooseVoice(language, voice); !chosen) {
      throw std::runtime_error(options.voices_path + ": " + chosen.error().text);
    }
  }
  return set;
}

void ReadConfig(Options& options) {
  auto config = ssm::ParseOriginalConfig(ReadFileOrThrow(options.config_path));
  if (!config) throw std::runtime_error(options.config_path + ": " + config.error().text);
  options.config = std::move(*config);
  if (!options.config.notice.empty()) Notice(options.config_path + ": " + options.config.notice);
}

/// stderr to the end of a file, or back to where it went at the start for CONSOLE.
vm::Result<void> RedirectErrors(const std::string& where) {
  static const int console = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  if (where != "CONSOLE") {
    if (auto fit = vm::CheckWritable(where); !fit) return fit;
  }
  const int target = where == "CONSOLE"
                         ? console
                         : open(where.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (target < 0 || dup2(target, STDERR_FILENO) < 0) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "cannot write '" + where + "': " + std::strerror(errno));
  }
  if (target != console) close(target);
  return {};
}

bool WantsRealClock(const Options& options) {
  using Kind = ssm::SinkChoice::Kind;
  return options.sink.kind == Kind::kPortAudio ||
         (options.sink.kind == Kind::kAuto && ssm::HasSoundDevice());
}

std::unique_ptr<vm::Module> MakeModule(const Options& options, vm::Scheduler& scheduler,
                                       boost::asio::io_context& io) {
  auto& clock = dynamic_cast<vm::ClockScheduler&>(scheduler);
  ssm::SinkChoice choice = options.sink;
  std::string notice;
  if (!clock.real()) {
    if (choice.kind == ssm::SinkChoice::Kind::kPortAudio) {
      throw std::runtime_error("--sink portaudio needs the real clock (--clock real)");
    }
    if (choice.kind == ssm::SinkChoice::Kind::kAuto) {
      choice.kind = ssm::SinkChoice::Kind::kNull;
      notice = "the clock is virtual, so nothing is heard; --sink file:PATH.wav keeps the sound";
    }
  }
  ssm::OpenedSink opened = ssm::OpenSink(choice, scheduler);
  if (!opened.notice.empty()) notice = opened.notice;
  // Said once it runs: --slots-markdown only asks what there is.
  if (!notice.empty()) boost::asio::post(io, [notice] { Notice(notice); });
  if (opened.sink->name().starts_with("portaudio:")) {
    opened.sink = std::make_unique<ssm::RealTimeSink>(clock, std::move(opened.sink));
  }
  auto sink = std::make_unique<ssm::CopyingSink>(scheduler, std::move(opened.sink));
  ssm::CopyingSink& copying = *sink;  // lives as long as the module
  ssm::VoiceModule::Options voice{
      .module_version = kModuleVersion,
      .speaker = options.speaker,
      .auto_play = options.config.auto_play,
      .auto_play_delay = options.config.auto_play_delay,
      .redirect_errors = RedirectErrors,
      .send_sound = [&copying](const std::string& to) { return copying.SendTo(to); },
      .sound_goes_to = [&copying] { return copying.to(); }};
  if (!options.config.speakers.empty()) {
    voice.aliases = options.config.speakers;
    if (voice.speaker.empty()) voice.speaker = voice.aliases.front().name;
  }
  return std::make_unique<ssm::VoiceModule>(
      scheduler,
      ssm::VoiceModule::Parts{MakeEngines(options), std::move(sink),
                              std::make_unique<ssm::ThreadWorker>(io, clock)},
      std::move(voice));
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  return vm::RunModule(
      argc, argv,
      {.name = "ssm",
       .description = "Speech synthesis module: text to speech with phonemes and their times",
       .module_name = "SSM",
       .original_port = 10600,
       .virtual_by_default = true,
       .add_options =
           [&options](CLI::App& app) {
             app.add_option("--sink", options.sink_text,
                            "Where sound goes: auto (a loudspeaker if there is one), null, "
                            "portaudio[:NAME], file:PATH.wav, raw:PATH");
             app.add_option("--speaker", options.speaker, "Who speaks at first (see SpeakerSet)");
             app.add_option("--voices", options.voices_path,
                            "Voices beside flite's, a JSON file (docs/speech.md)");
             app.add_option("--mecab-dictionary", options.dictionary,
                            "Folder of the dictionary that reads Japanese");
             app.add_option("-C", options.config_path, "The original's ssm.conf");
             app.add_flag("-v", options.print_version, "Print the versions and end");
           },
       .before_start =
           [&options] {
             if (options.print_version) {
               std::cout << kModuleVersion << "\nProtocol Ver. 1.0" << std::endl;
               return 0;
             }
             auto choice = ssm::ParseSinkChoice(options.sink_text);
             if (!choice) throw std::runtime_error("--sink: " + choice.error().text);
             options.sink = std::move(*choice);
             if (!options.config_path.empty()) ReadConfig(options);
             return -1;
           },
       .needs_real_clock = [&options] { return WantsRealClock(options); },
       .make = [&options](
                   vm::Scheduler& scheduler,
                   boost::asio::io_context& io) { return MakeModule(options, scheduler, io); }});
}
