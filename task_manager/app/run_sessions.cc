#include <algorithm>
#include <deque>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "task_manager/app/options.h"
#include "task_manager/app/readable.h"
#include "task_manager/app/session_processes.h"

namespace vxml {
namespace {

std::string ReadAll(const std::string& path) {
  if (path == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("--script '" + path + "': cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

CommandSource SourceOf(const std::string& script) {
  auto parsed = ParseInputScript(ReadAll(script), script);
  if (!parsed) throw std::runtime_error(parsed.error().text);
  auto left = std::make_shared<std::deque<Command>>(parsed->begin(), parsed->end());
  return [left]() -> std::optional<Command> {
    if (left->empty()) return {};
    Command command = std::move(left->front());
    left->pop_front();
    return command;
  };
}

/// Where the transcripts go. Those of text sessions follow one another in the order of the
/// sessions; at a hub they come as they come.
class Transcripts {
 public:
  explicit Transcripts(const Options& options)
      : options_(options),
        json_(options.transcript == "json" ||
              (options.transcript == "auto" && !options.scripts.empty())),
        sides_(options.scripts.empty() ? Sides::kAgent : Sides::kBoth),
        in_order_(options.sessions > 1 && options.connect.empty()) {
    held_.resize(static_cast<std::size_t>(options.sessions));
    if (options.transcript_file.empty()) return;
    file_.open(options.transcript_file, std::ios::binary);
    if (!file_) {
      throw std::runtime_error("--transcript-file '" + options.transcript_file +
                               "': cannot be written");
    }
  }

  void Add(int session, const std::string& line) {
    if (options_.transcript == "none") return;
    std::string told = line;
    if (options_.sessions > 1) {
      JsonLine numbered;
      told = numbered.Number("session", session + 1).Add(line).str();
    }
    if (!json_) told = Readable(told, sides_);
    if (told.empty()) return;
    if (in_order_) {
      held_[static_cast<std::size_t>(session)] += told + "\n";
    } else {
      out() << told << std::endl;
    }
  }

  void Finish() {
    for (const std::string& text : held_) out() << text;
    out().flush();
  }

 private:
  std::ostream& out() { return file_.is_open() ? file_ : std::cout; }

  const Options& options_;
  bool json_;
  Sides sides_;
  bool in_order_;
  std::vector<std::string> held_;
  std::ofstream file_;
};

}  // namespace

int RunSessions(const Options& options) {
  const bool at_hub = options.platform == "agent" || !options.connect.empty();
  if (at_hub && options.connect.empty()) {
    throw std::runtime_error("--platform agent needs --connect");
  }
  if (!at_hub && options.sessions > 1 && options.scripts.empty()) {
    throw std::runtime_error("--sessions needs --script");
  }
  if (!options.out.empty() && !at_hub) throw std::runtime_error("--out needs --connect");
  if (!options.trace.empty() && options.sessions > 1) {
    throw std::runtime_error("--trace is for one session");
  }
  if (options.sessions > 1 && std::ranges::find(options.scripts, "-") != options.scripts.end()) {
    throw std::runtime_error("--script - is for one session");
  }
  static_cast<void>(MakeSessionOptions(options));  // says what is wrong before anything runs
  std::vector<CommandSource> sources;
  for (int i = 0; i < options.sessions && !options.scripts.empty(); ++i) {
    sources.push_back(
        SourceOf(options.scripts[static_cast<std::size_t>(i) % options.scripts.size()]));
  }
  Transcripts transcripts(options);
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const SessionProcesses sessions{
      .count = options.sessions,
      .at_once = at_hub ? options.sessions : cores,
      .run =
          [&](int number, const WriteLine& to_caller) {
            // Nobody wants to see a line: none is handed over.
            const WriteLine write =
                options.transcript == "none" ? [](const std::string&) {} : to_caller;
            const CommandSource source =
                sources.empty() ? nullptr : sources[static_cast<std::size_t>(number)];
            return at_hub ? RunAgentSession(options, number, source, write)
                          : RunTextSession(options, source, write);
          },
      .on_line = [&](int number, const std::string& line) { transcripts.Add(number, line); }};
  const int code = sessions.Run();
  transcripts.Finish();
  return code;
}

}  // namespace vxml
