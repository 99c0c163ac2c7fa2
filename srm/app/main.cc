// The speech recognition module: options, the engine, sources of sound, and the module over them.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "ear/grammar/grammar_limits.h"
#include "sound/sources.h"
#include "srm/core/recognizer_module.h"
#include "srm/http/http_transcriber.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/http/curl_transport.h"
#include "vm_protocol/runtime/asio_scheduler.h"
#include "vm_protocol/runtime/module_main.h"

namespace {

constexpr std::size_t kMaxConfigBytes = 64 << 10;

srm::HttpEarSettings ReadServer(const std::string& config) {
  const auto text = vm::ReadTextFile(config, kMaxConfigBytes);
  if (!text) throw std::runtime_error(text.error().text);
  const std::string folder = std::filesystem::path(config).parent_path().string();
  auto settings = srm::ParseHttpEar(*text, folder.empty() ? "." : folder);
  if (!settings) throw std::runtime_error(config + ": " + settings.error().text);
  return std::move(*settings);
}

std::unique_ptr<srm::Transcriber> OpenServer(srm::HttpEarSettings settings,
                                             vm::ClockScheduler& clock,
                                             boost::asio::io_context& io) {
  auto transport = std::make_shared<vm::CurlTransport>(
      io, clock, [&clock] { return clock.real(); }, settings.server.ca_file);
  return std::make_unique<srm::HttpTranscriber>(clock, std::move(transport), std::move(settings));
}

}  // namespace

int main(int argc, char** argv) {
  srm::PocketsphinxOptions engine;
  std::string server;
  bool accept_all = false, real = false;
  const bool stdin_free = std::any_of(argv + 1, argv + argc, [](std::string_view word) {
    return word.starts_with("--listen") || word.starts_with("--connect") || word == "-p";
  });
  return vm::RunModule(
      argc, argv,
      {.name = "srm",
       .description = "Speech recognition module: speech to text by grammars or dictation",
       .module_name = "SRM",
       .virtual_by_default = true,
       .add_options =
           [&](CLI::App& app) {
             app.add_option("--model", engine.model, "Folder of the recognition model");
             app.add_option("--server", server,
                            "Who has the words in place of the engine: a JSON file that names an "
                            "OpenAI-compatible server (docs/speech.md)");
             app.add_flag("--no-rejection", accept_all,
                          "Take whatever fits a grammar best, however badly");
             app.add_flag("--live", real, "Sound comes from a microphone or pipe: the real clock");
           },
       .before_start =
           [&] {
             engine.rejection = !accept_all;
             return -1;
           },
       .needs_real_clock = [&] { return real; },
       .make =
           [&](vm::Scheduler& scheduler, boost::asio::io_context& io) {
             auto& clock = dynamic_cast<vm::ClockScheduler&>(scheduler);
             // Debian's model is of English; of another one nothing tells its language.
             std::string languages = engine.model == srm::PocketsphinxOptions{}.model ? "en" : "*";
             std::unique_ptr<srm::Transcriber> transcriber;
             if (!server.empty()) {
               auto settings = ReadServer(server);
               languages = settings.language.empty() ? "*" : settings.language;
               transcriber = OpenServer(std::move(settings), clock, io);
             }
             return std::make_unique<srm::RecognizerModule>(
                 scheduler,
                 srm::RecognizerModule::Options{
                     .module_version = "Galatea SRM " GALATEA_VERSION,
                     .languages = std::move(languages),
                     .read_file =
                         [](const std::string& path) {
                           return vm::ReadTextFile(path, ear::kMaxGrammarBytes);
                         },
                     .open_decoder = [&]() -> vm::Result<std::unique_ptr<srm::SpeechDecoder>> {
                       if (!server.empty()) return srm::MakeDeafDecoder();
                       return srm::OpenPocketsphinx(engine);
                     },
                     .open_spotter = [&engine] { return srm::OpenSpotter(engine); },
                     .transcriber = std::move(transcriber),
                     .open_source = [&](const std::string& name)
                         -> vm::Result<std::unique_ptr<sound::AudioSource>> {
                       if (name.ends_with(":-") && !stdin_free) {
                         return vm::Fail(vm::Errc::kUnavailable,
                                         "standard input brings the commands; "
                                         "run with --listen or --connect");
                       }
                       return sound::OpenSource(name, clock, io, clock.real());
                     }});
           }});
}
