#include <atomic>
#include <deque>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <sstream>
#include <thread>

#include "task_manager/app/options.h"
#include "task_manager/app/readable.h"
#include "task_manager/platform/text_platform.h"

namespace vxml {
namespace {

std::string ReadAll(const std::string& path) {
  if (path == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("--script '" + path + "': cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

CommandSource FromScript(const std::string& path) {
  auto parsed = ParseInputScript(ReadAll(path), path);
  if (!parsed) throw std::runtime_error(parsed.error().text);
  auto left = std::make_shared<std::deque<Command>>(parsed->begin(), parsed->end());
  return [left]() -> std::optional<Command> {
    if (left->empty()) return {};
    Command command = std::move(left->front());
    left->pop_front();
    return command;
  };
}

/// Typed lines are said; with '/' in front they are commands of the input script.
std::optional<Command> FromTerminal() {
  std::string line;
  while (std::cout.flush(), std::getline(std::cin, line)) {
    if (vm::xml::IsBlank(line)) {
      Command silence;
      silence.kind = Command::Kind::kSilence;
      return silence;
    }
    auto command = ParseCommand(line[0] == '/' ? line.substr(1) : "say " + line);
    if (command) return *command;
    std::cerr << "task_manager: " << command.error().text << "\n";
  }
  return {};
}

class Output {
 public:
  explicit Output(const Options& options)
      : json_(options.transcript == "json"),
        sides_(options.scripts.empty() ? Sides::kAgent : Sides::kBoth) {
    if (options.transcript == "auto") json_ = !options.scripts.empty();
    silent_ = options.transcript == "none";
    if (!options.transcript_file.empty()) {
      file_.open(options.transcript_file, std::ios::binary);
      if (!file_) {
        throw std::runtime_error("--transcript-file '" + options.transcript_file +
                                 "': cannot be written");
      }
    }
  }
  void Write(const std::string& line) {
    if (silent_) return;
    std::ostream& out = file_.is_open() ? static_cast<std::ostream&>(file_) : std::cout;
    if (json_) {
      out << line << "\n";
    } else {
      const std::string text = Readable(line, sides_);
      if (!text.empty()) out << text << "\n";
    }
  }

 private:
  bool json_;
  Sides sides_;
  bool silent_ = false;
  std::ofstream file_;
};

int CodeOf(const SessionResult& result, bool ran_out) {
  if (result.failed && !result.reason.starts_with("error.badfetch.start")) return kFailed;
  return ran_out ? kRanOut : kEnded;
}

int RunOne(const Options& options, const std::string& script, Output& output, std::ostream* trace) {
  TextPlatform platform(script.empty() ? CommandSource(FromTerminal) : FromScript(script),
                        [&](const std::string& line) { output.Write(line); });
  if (script.empty()) platform.SetInteractive();
  SessionOptions session_options = MakeSessionOptions(options);
  if (trace) {
    session_options.trace = [&](std::string_view kind, const JsonLine& fields) {
      JsonLine head;
      head.Number("t", static_cast<double>(platform.Now().count())).Text("trace", kind);
      *trace << head.Add(fields).str() << std::endl;
    };
  }
  DialogSession session(std::move(session_options), platform);
  const SessionResult result = session.Run();
  if (result.failed && !session.started()) return kNotStarted;
  return CodeOf(result, platform.ran_out());
}

/// Sessions side by side, one thread each, each with its own script (the scripts in turn); their
/// transcripts follow one another in the order of the sessions.
int RunMany(const Options& options) {
  const auto count = static_cast<std::size_t>(options.sessions);
  std::vector<std::ostringstream> texts(count);
  std::vector<int> codes(count, kEnded);
  std::vector<CommandSource> sources;
  for (std::size_t i = 0; i < count; ++i) {
    if (options.scripts.empty()) throw std::runtime_error("--sessions needs --script");
    sources.push_back(FromScript(options.scripts[i % options.scripts.size()]));
  }
  const SessionOptions session_options = MakeSessionOptions(options);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < count;) {
      TextPlatform platform(sources[i], [&texts, i](const std::string& line) {
        JsonLine numbered;
        numbered.Number("session", static_cast<double>(i + 1)).Add(line);
        texts[i] << numbered.str() << "\n";
      });
      DialogSession session(session_options, platform);
      const SessionResult result = session.Run();
      codes[i] =
          result.failed && !session.started() ? kNotStarted : CodeOf(result, platform.ran_out());
    }
  };
  std::vector<std::thread> threads;
  const std::size_t workers =
      std::min<std::size_t>(count, std::max(1U, std::thread::hardware_concurrency()));
  for (std::size_t i = 0; i < workers; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  Output output(options);
  for (std::ostringstream& text : texts) {
    std::istringstream lines(text.str());
    for (std::string line; std::getline(lines, line);) output.Write(line);
  }
  return *std::max_element(codes.begin(), codes.end());
}

}  // namespace

int RunText(const Options& options) {
  if (options.sessions > 1) return RunMany(options);
  Output output(options);
  std::ofstream trace_file;
  std::ostream* trace = nullptr;
  if (options.trace == "-") {
    trace = &std::cerr;
  } else if (!options.trace.empty()) {
    trace_file.open(options.trace, std::ios::binary);
    if (!trace_file) throw std::runtime_error("--trace '" + options.trace + "': cannot be written");
    trace = &trace_file;
  }
  return RunOne(options, options.scripts.empty() ? "" : options.scripts.front(), output, trace);
}

}  // namespace vxml
