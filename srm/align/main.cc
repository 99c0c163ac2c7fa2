// align: when each phoneme of a recording is spoken. See --help and docs/speech.md.

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "sound/sound_file.h"
#include "srm/align/phone_aligner.h"
#include "srm/align/speech_guesser.h"

namespace {

using Json = nlohmann::json;

struct Options {
  std::string wav, text, text_file;
  std::string format = "pho";
  std::string model = srm::PocketsphinxOptions().model;
  bool resident = false;
  bool progress = false;
};

/// Opened when they are first needed.
struct Ears {
  std::string model;
  std::unique_ptr<srm::PhoneAligner> aligner{};
  std::unique_ptr<srm::SpeechGuesser> guesser{};

  template <typename Ear>
  static vm::Result<void> Need(std::unique_ptr<Ear>& ear, const std::string& model) {
    if (ear) return {};
    auto opened = Ear::Open(model);
    if (!opened) return std::unexpected(opened.error());
    ear = std::move(*opened);
    return {};
  }
  vm::Result<srm::Alignment> Hear(const std::vector<std::int16_t>& samples,
                                  const std::string& text) {
    if (text.empty()) {
      if (auto open = Need(guesser, model); !open) return std::unexpected(open.error());
      return guesser->Guess(samples);
    }
    if (auto open = Need(aligner, model); !open) return std::unexpected(open.error());
    return aligner->Align(samples, text);
  }
};

vm::Result<std::string> Run(Ears& ears, const Options& options, const std::string& wav,
                            const std::string& text) {
  auto samples = sound::ReadSound(wav);
  if (!samples) return std::unexpected(samples.error());
  if (options.progress) {
    std::cerr << "align: " << wav << ": " << samples->size() / srm::kSampleRateHz << " s"
              << std::endl;
  }
  const auto found = ears.Hear(*samples, text);
  if (!found) return std::unexpected(found.error());
  return srm::FormatAlignment(*found, options.format);
}

/// One job a line: {"wav": PATH, "text": TEXT} or PATH, a tab and the text.
bool ReadJob(const std::string& line, std::string& wav, std::string& text) {
  if (!line.starts_with('{')) {
    const std::size_t tab = line.find('\t');
    wav = line.substr(0, tab);
    text = tab == std::string::npos ? "" : line.substr(tab + 1);
    return !wav.empty();
  }
  const Json job = Json::parse(line, nullptr, false);
  if (!job.is_object() || !job.contains("wav") || !job["wav"].is_string()) return false;
  wav = job["wav"].get<std::string>();
  text = job.contains("text") && job["text"].is_string() ? job["text"].get<std::string>() : "";
  return true;
}

void ServeJobs(Ears& ears, const Options& options) {
  for (std::string line, wav, text; std::getline(std::cin, line);) {
    if (line.empty()) continue;
    auto answer =
        ReadJob(line, wav, text)
            ? Run(ears, options, wav, text)
            : vm::Fail(vm::Errc::kSyntax, "found '" + line.substr(0, 40) +
                                              "', expected {\"wav\": ..., \"text\": ...}");
    if (answer) {
      std::cout << *answer << std::flush;
    } else if (options.format == "json") {
      const Json error = {{"error", vm::FormatError(answer.error())}};
      std::cout << error.dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
    } else {
      std::cout << "error " << answer.error().text << std::endl;
    }
  }
}

int Once(Ears& ears, Options options) {
  if (!options.text_file.empty()) {
    std::ifstream file(options.text_file);
    if (!file) {
      std::cerr << "align: cannot read '" << options.text_file << "': " << std::strerror(errno)
                << std::endl;
      return 1;
    }
    options.text.assign(std::istreambuf_iterator<char>(file), {});
  }
  auto answer = Run(ears, options, options.wav, options.text);
  if (!answer) {
    std::cerr << "align: " << answer.error().text << std::endl;
    return 1;
  }
  std::cout << *answer;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Finds when each phoneme of a recording is spoken");
  app.set_version_flag("--version", "align (Galatea) " GALATEA_VERSION);
  app.add_option("wav", options.wav, "The recording (any format libsndfile reads)");
  app.add_option("-t,--text", options.text, "What is said in it; without it, words are recognised");
  app.add_option("--text-file", options.text_file, "The same from a file");
  app.add_option("-f,--format", options.format, "pho (name[ms] ...), tsv, json or textgrid");
  app.add_option("--model", options.model, "Folder of the recognition model");
  app.add_flag(
      "--resident", options.resident,
      "Reads jobs from standard input, one a line: WAV, a tab, TEXT; or a JSON object with "
      "wav and text. The answers come in the same order");
  app.add_flag("--progress", options.progress, "Says on standard error what is worked on");
  CLI11_PARSE(app, argc, argv);
  if (auto known = srm::FormatAlignment({}, options.format); !known) {
    std::cerr << "align: --format: " << known.error().text << std::endl;
    return 1;
  }
  if (options.wav.empty() && !options.resident) {
    std::cerr << "align: expected a WAV file or --resident" << std::endl;
    return 1;
  }
  Ears ears{.model = options.model};
  if (!options.resident) return Once(ears, options);
  // Without a model no job can be done.
  if (auto open = Ears::Need(ears.aligner, ears.model); !open) {
    std::cerr << "align: " << open.error().text << std::endl;
    return 1;
  }
  ServeJobs(ears, options);
  return 0;
}
