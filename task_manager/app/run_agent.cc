#include <iostream>
#include <stdexcept>

#include "task_manager/app/options.h"
#include "task_manager/app/subtitles.h"
#include "task_manager/platform/agent_platform.h"

namespace vxml {

int RunAgentSession(const Options& options, int number, const CommandSource& source,
                    const WriteLine& write) {
  const std::string name = number == 0 ? options.name : options.name + std::to_string(number + 1);
  const bool keyboard = !source && options.sessions == 1;
  HubLink hub({options.connect, options.credentials}, name, keyboard);
  AgentPlatform::Options platform_options;
  platform_options.name = name;
  platform_options.script = source;
  Subtitles subtitles;
  platform_options.write = [&](const std::string& line) {
    if (!options.out.empty()) subtitles.Add(line);
    write(line);
  };
  AgentPlatform platform(hub, std::move(platform_options));
  if (!options.out.empty()) {
    auto begun = hub.Ask("to @AM-MCL set Record = " + options.out, Millis(10'000));
    if (!begun) throw std::runtime_error("--out " + options.out + ": " + begun.error().text);
    platform.StartTime();
  }
  SessionOptions session_options = MakeSessionOptions(options);
  if (!options.trace.empty() && options.sessions == 1) {
    session_options.trace = [](std::string_view kind, const JsonLine& fields) {
      JsonLine line;
      std::cerr << line.Text("trace", kind).Add(fields).str() << "\n";
    };
  }
  DialogSession session(std::move(session_options), platform);
  const SessionResult result = session.Run();
  if (!options.out.empty()) {
    platform.Pause(Millis(700));
    auto made = hub.Ask("to @AM-MCL set Record = STOP", Millis(180'000));
    if (!made) throw std::runtime_error("--out " + options.out + ": " + made.error().text);
    auto written = subtitles.WriteBeside(options.out);
    if (!written) throw std::runtime_error("--out " + options.out + ": " + written.error().text);
  }
  return CodeOf(result, session.started(), platform.ran_out());
}

}  // namespace vxml
