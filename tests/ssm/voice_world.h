#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ssm/voice/voice_module.h"
#include "vm_protocol/core/scheduler.h"

/// A voice module on a virtual clock with nothing outside it: what it says is kept with its time.
namespace ssm_test {

struct Said {
  double ms;
  std::string line;
};

class VoiceWorld {
 public:
  explicit VoiceWorld(std::unique_ptr<ssm::SpeechEngine> engine,
                      std::unique_ptr<ssm::Worker> worker = std::make_unique<ssm::InlineWorker>(),
                      ssm::VoiceModule::Options options = {}) {
    if (options.module_version.empty()) options.module_version = "test";
    options.wall_clock = [this] { return wall; };
    module = std::make_unique<ssm::VoiceModule>(
        clock,
        ssm::VoiceModule::Parts{std::move(engine), std::make_unique<ssm::ClockSink>(clock),
                                std::move(worker)},
        std::move(options));
    module->slots().set_output([this](vm::PeerId, const vm::Message& message) {
      said.push_back({Now(), vm::FormatMessage(message)});
    });
    module->slots().set_on_error([this](vm::PeerId, const std::string&, const vm::Error& error) {
      errors.push_back(vm::FormatError(error));
    });
  }

  double Now() const { return static_cast<double>(clock.Now().count()) / 1000; }
  void Tell(const std::string& line) { module->slots().HandleLine(line, 1); }
  void Pass(double ms) {
    clock.RunUntil(clock.Now() + vm::Time(static_cast<std::int64_t>(ms * 1000)));
  }
  void UntilIdle() { clock.RunUntilIdle(clock.Now() + std::chrono::hours(25)); }
  /// What was said since the last call.
  std::vector<std::string> Lines() {
    std::vector<std::string> lines;
    for (Said& one : std::exchange(said, {})) lines.push_back(std::move(one.line));
    return lines;
  }
  /// When a line with this beginning was said first; -1 if never.
  double When(const std::string& beginning) const {
    for (const Said& one : said) {
      if (one.line.starts_with(beginning)) return one.ms;
    }
    return -1;
  }
  std::string Ask(const std::string& slot) const { return module->slots().Value(slot); }

  vm::VirtualScheduler clock;
  vm::Time wall{0};
  std::unique_ptr<ssm::VoiceModule> module;
  std::vector<Said> said;
  std::vector<std::string> errors;
};

}  // namespace ssm_test
