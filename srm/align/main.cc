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

namespace {

using Json = nlohmann::json;

struct Options {
  std::string wav, text, text_file;
  std::string format = "pho";
  std::string model = srm::PocketsphinxOptions().model;
  bool resident = false;
  bool progress = false;
};

vm::Result<std::string> Run(srm::PhoneAligner& aligner, const Options& options,
                            const std::string& wav, const std::string& text) {
  auto samples = sound::ReadSound(wav);
  if (!samples) return std::unexpected(samples.error());
  if (options.progress) {
    std::cerr << "align: " << wav << ": " << samples->size() / srm::kSampleRateHz << " s"
              << std::endl;
  }
  auto found = text.empty() ? aligner.Guess(*samples) : aligner.Align(*samples, text);
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

void ServeJobs(srm::PhoneAligner& aligner, const Options& options) {
  for (std::string line, wav, text; std::getline(std::cin, line);) {
    if (line.empty()) continue;
    auto answer =
        ReadJob(line, wav, text)
            ? Run(aligner, options, wav, text)
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

int Once(srm::PhoneAligner& aligner, Options options) {
  if (!options.text_file.empty()) {
    std::ifstream file(options.text_file);
    if (!file) {
      std::cerr << "align: cannot read '" << options.text_file << "': " << std::strerror(errno)
                << std::endl;
      return 1;
    }
    options.text.assign(std::istreambuf_iterator<char>(file), {});
  }
  auto answer = Run(aligner, options, options.wav, options.text);
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
  app.add_option("-t,--text", options.text, "What is said in it; without it, phonemes are guessed");
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
  auto aligner = srm::PhoneAligner::Open(options.model);
  if (!aligner) {
    std::cerr << "align: " << aligner.error().text << std::endl;
    return 1;
  }
  if (!options.resident) return Once(**aligner, options);
  ServeJobs(**aligner, options);
  return 0;
}
