#include "agent_manager/supervision/supervisor.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace am {

using vm::Errc;
using State = ManagedModule::State;

namespace {

vm::Error NoSuchModule(const std::string& name) {
  return {Errc::kUnknownModule, "@" + name + " is not configured", 0};
}

}  // namespace

Supervisor::Supervisor(boost::asio::io_context& io, Hub& hub, OnNotice on_notice,
                       OnOutput on_output)
    : io_(io),
      hub_(hub),
      reaper_(io),
      events_{.on_notice = std::move(on_notice),
              .on_output = std::move(on_output),
              .on_ready = [this] { StartWhatCan(); },
              .on_stopped = [this](ManagedModule& module) { OnStopped(module); }} {}

Supervisor::ModulePtr Supervisor::Find(const std::string& name) const {
  const auto found = std::ranges::find_if(modules_, [&](const ModulePtr& module) {
    return module->config().name == name && !module->removed();
  });
  return found == modules_.end() ? nullptr : *found;
}

bool Supervisor::IsReady(const std::string& name) const {
  const ModulePtr module = Find(name);
  return module != nullptr && module->state() == State::kReady;
}

bool Supervisor::IsExpected(const ManagedModule& module) const {
  switch (module.state()) {
    case State::kWaiting:
      return std::ranges::all_of(module.config().after, [this](const std::string& name) {
        const ModulePtr before = Find(name);
        return before != nullptr && (before->state() == State::kReady || IsExpected(*before));
      });
    case State::kStarting:
    case State::kReady:
      return module.has_process();
    case State::kRestarting:
      return true;
    default:
      return false;
  }
}

bool Supervisor::AllReady() const {
  return std::ranges::none_of(modules_, [this](const ModulePtr& module) {
    return module->state() != State::kReady && IsExpected(*module);
  });
}

void Supervisor::StartWhatCan() {
  if (stopping_) return;
  const auto modules = modules_;
  for (const ModulePtr& module : modules) {
    const bool may_start =
        module->state() == State::kWaiting &&
        std::ranges::all_of(module->config().after,
                            [this](const std::string& name) { return IsReady(name); });
    if (!may_start) continue;
    const auto started = module->Start(watch_health_);
    // The module has told why.
    if (!started && first_apply_)
      throw std::runtime_error("the modules of the configuration could not all be started");
  }
}

void Supervisor::Apply(const std::vector<ModuleConfig>& modules) {
  const auto before = modules_;
  for (const ModulePtr& module : before) {
    const auto wanted = std::ranges::find(modules, module->config().name, &ModuleConfig::name);
    if (wanted == modules.end()) {
      module->Replace(std::nullopt);
    } else if (module->has_replacement() || *wanted != module->config()) {
      module->Replace(*wanted);
    }
  }
  for (const ModuleConfig& module : modules) {
    if (Find(module.name) == nullptr)
      modules_.push_back(std::make_shared<ManagedModule>(io_, hub_, reaper_, module, events_));
  }
  StartWhatCan();
  first_apply_ = false;
}

void Supervisor::StartOne(const std::string& name, Done done) {
  const ModulePtr module = Find(name);
  if (module == nullptr) return done(std::unexpected(NoSuchModule(name)));
  if (stopping_) return done(vm::Fail(Errc::kBusy, "@" + name + " is being stopped"));
  module->AskToStart(std::move(done));
  StartWhatCan();
}

void Supervisor::StopOne(const std::string& name, Done done) {
  const ModulePtr module = Find(name);
  if (module == nullptr) return done(std::unexpected(NoSuchModule(name)));
  module->Stop(std::move(done));
}

void Supervisor::RestartOne(const std::string& name, Done done) {
  StopOne(name, [this, name, done](const vm::Result<std::string>& stopped) {
    if (!stopped) return done(stopped);
    StartOne(name, done);
  });
}

void Supervisor::OnStopped(ManagedModule& module) {
  if (module.removed())
    std::erase_if(modules_, [&](const ModulePtr& m) { return m.get() == &module; });
  if (stopping_) return StopNext();
  if (module.TakeReplacement()) StartWhatCan();
}

void Supervisor::StopAll(std::function<void()> done) {
  if (stopping_) return;
  stopping_ = true;
  on_all_stopped_ = std::move(done);
  for (const ModulePtr& module : modules_) module->StopRestarting();
  StopNext();
}

void Supervisor::StopNext() {
  // One at a time: the last one that no other running module comes after.
  const auto needed = [this](const ManagedModule& module) {
    return std::ranges::any_of(modules_, [&](const ModulePtr& other) {
      const auto& after = other->config().after;
      return other->has_run() && std::ranges::find(after, module.config().name) != after.end();
    });
  };
  for (const ModulePtr& module : modules_) {
    if (module->has_run() && module->state() == State::kStopping)
      return;  // its end comes back here
  }
  for (auto at = modules_.rbegin(); at != modules_.rend(); ++at) {
    if ((*at)->has_run() && !needed(**at)) return (*at)->Stop();
  }
  if (auto done = std::exchange(on_all_stopped_, nullptr)) done();
}

void Supervisor::OnPresent(const std::string& name) {
  if (const ModulePtr module = Find(name)) module->OnPresent();
}

bool Supervisor::Kill(const std::string& name, const std::string& why) {
  const ModulePtr module = Find(name);
  return module != nullptr && module->Kill(why);
}

std::vector<ModuleStatus> Supervisor::Status() const {
  std::vector<ModuleStatus> all;
  for (const ModulePtr& module : modules_) all.push_back(module->Status());
  return all;
}

std::deque<OutputLine> Supervisor::Output(const std::string& name) const {
  const ModulePtr module = Find(name);
  return module == nullptr ? std::deque<OutputLine>{} : module->output().lines();
}

}  // namespace am
