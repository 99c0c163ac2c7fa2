#include <fstream>
#include <iostream>
#include <stdexcept>

#include "task_manager/app/options.h"
#include "task_manager/platform/text_platform.h"

namespace vxml {
namespace {

/// Typed lines are said; with '/' in front they are commands of the input script.
std::optional<Command> FromTerminal() {
  std::string line;
  while (std::getline(std::cin, line)) {
    if (vm::xml::IsBlank(line)) {
      Command silence;
      silence.kind = Command::Kind::kSilence;
      return silence;
    }
    if (line[0] != '/') {
      Command said;
      said.kind = Command::Kind::kSay;
      said.hypotheses = {{line, 1.0}};
      return said;
    }
    auto command = ParseCommand(line.substr(1));
    if (command) return *command;
    std::cerr << "task_manager: " << command.error().text << "\n";
  }
  return {};
}

}  // namespace

int RunTextSession(const Options& options, const CommandSource& source, const WriteLine& write) {
  std::ofstream trace_file;
  if (!options.trace.empty() && options.trace != "-") {
    trace_file.open(options.trace, std::ios::binary);
    if (!trace_file) throw std::runtime_error("--trace '" + options.trace + "': cannot be written");
  }
  TextPlatform platform(source ? source : CommandSource(FromTerminal), write);
  if (!source) platform.SetInteractive();
  SessionOptions session_options = MakeSessionOptions(options);
  if (!options.trace.empty() && options.sessions == 1) {
    std::ostream& trace = trace_file.is_open() ? static_cast<std::ostream&>(trace_file) : std::cerr;
    session_options.trace = [&](std::string_view kind, const JsonLine& fields) {
      JsonLine head;
      head.Number("t", static_cast<double>(platform.Now().count())).Text("trace", kind);
      trace << head.Add(fields).str() << std::endl;
    };
  }
  DialogSession session(std::move(session_options), platform);
  const SessionResult result = session.Run();
  return CodeOf(result, session.started(), platform.ran_out());
}

}  // namespace vxml
