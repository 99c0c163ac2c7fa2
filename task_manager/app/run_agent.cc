#include <algorithm>
#include <deque>
#include <fstream>
#include <iostream>
#include <iterator>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "task_manager/app/options.h"
#include "task_manager/app/readable.h"
#include "task_manager/app/subtitles.h"
#include "task_manager/platform/agent_platform.h"

namespace vxml {
namespace {

CommandSource ReadScript(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("--script '" + path + "': cannot be read");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  auto parsed = ParseInputScript(text, path);
  if (!parsed) throw std::runtime_error(parsed.error().text);
  auto left = std::make_shared<std::deque<Command>>(parsed->begin(), parsed->end());
  return [left]() -> std::optional<Command> {
    if (left->empty()) return {};
    Command command = std::move(left->front());
    left->pop_front();
    return command;
  };
}

int RunOne(const Options& options, int number, std::mutex& out) {
  const std::string name = number == 0 ? options.name : options.name + std::to_string(number + 1);
  const bool keyboard = options.scripts.empty() && options.sessions == 1;
  HubLink hub({options.connect, options.credentials}, name, keyboard);
  AgentPlatform::Options platform_options;
  platform_options.name = name;
  if (!options.scripts.empty()) {
    platform_options.script =
        ReadScript(options.scripts[static_cast<std::size_t>(number) % options.scripts.size()]);
  }
  const bool json =
      options.transcript == "json" || (options.transcript == "auto" && !options.scripts.empty());
  const Sides sides = options.scripts.empty() ? Sides::kAgent : Sides::kBoth;
  Subtitles subtitles;
  platform_options.write = [&](const std::string& line) {
    if (!options.out.empty()) subtitles.Add(line);
    if (options.transcript == "none") return;
    const std::string text = json ? line : Readable(line, sides);
    const std::scoped_lock lock(out);
    if (!text.empty()) std::cout << text << std::endl;
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
    if (made) {
      if (auto written = subtitles.WriteBeside(options.out); !written)
        made = std::unexpected(written.error());
    }
    if (!made) throw std::runtime_error("--out " + options.out + ": " + made.error().text);
  }
  if (result.failed) return session.started() ? kFailed : kNotStarted;
  return platform.ran_out() ? kRanOut : kEnded;
}

}  // namespace

int RunAgent(const Options& options) {
  if (options.connect.empty()) throw std::runtime_error("--platform agent needs --connect");
  std::mutex out;
  if (options.sessions == 1) return RunOne(options, 0, out);
  std::vector<int> codes(static_cast<std::size_t>(options.sessions), kEnded);
  std::vector<std::thread> threads;
  for (int i = 0; i < options.sessions; ++i) {
    threads.emplace_back([&, i] {
      try {
        codes[static_cast<std::size_t>(i)] = RunOne(options, i, out);
      } catch (const std::exception& error) {
        const std::scoped_lock lock(out);
        std::cerr << "task_manager: session " << i + 1 << ": " << error.what() << "\n";
        codes[static_cast<std::size_t>(i)] = kNotStarted;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  return *std::max_element(codes.begin(), codes.end());
}

}  // namespace vxml
