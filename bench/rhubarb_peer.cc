#include "bench/rhubarb_peer.h"

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "ssm/process/child_process.h"

namespace speech_bench {
namespace {

double ChildrenSeconds() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

vm::Result<std::vector<Interval>> Peer::Closed(const std::string& wav_path,
                                               const std::string& text_path) {
  const double before = ChildrenSeconds();
  auto answer = ssm::RunProgram({.argv = {program, "-q", "-f", "json", "-r", "pocketSphinx",
                                          "--extendedShapes", "GHX", "-d", text_path, wav_path},
                                 .limit = std::chrono::minutes(2)},
                                nullptr);
  work_s += ChildrenSeconds() - before;
  if (!answer) return std::unexpected(answer.error());
  return ClosedMouths(*answer);
}

bool IsOnPath(const std::string& program) {
  const char* path = std::getenv("PATH");
  if (program.find('/') != std::string::npos) return access(program.c_str(), X_OK) == 0;
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

vm::Result<std::vector<Interval>> ClosedMouths(std::string_view json) {
  const auto bad = [](const std::string& what) {
    return vm::Fail(vm::Errc::kBadValue, "the answer of rhubarb: " + what);
  };
  const auto answer = nlohmann::json::parse(json, nullptr, false);
  if (answer.is_discarded()) return bad("no JSON");
  if (!answer.is_object() || !answer.contains("mouthCues") || !answer["mouthCues"].is_array()) {
    return bad("expected {\"mouthCues\": [...]}");
  }
  std::vector<Interval> closed;
  for (const auto& cue : answer["mouthCues"]) {
    if (!cue.is_object() || !cue.contains("start") || !cue["start"].is_number() ||
        !cue.contains("end") || !cue["end"].is_number() || !cue.contains("value") ||
        !cue["value"].is_string()) {
      return bad("expected {\"start\": S, \"end\": S, \"value\": SHAPE}, found " + cue.dump());
    }
    const auto shape = cue["value"].get<std::string>();
    if (shape != "A" && shape != "X") continue;
    closed.push_back({cue["start"].get<double>() * 1000, cue["end"].get<double>() * 1000, shape});
  }
  return closed;
}

}  // namespace speech_bench
