#include "srm/core/recognizer_module.h"

#include <utility>

namespace srm {

RecognizerModule::RecognizerModule(vm::Scheduler& scheduler, Options options)
    : scheduler_(scheduler),
      options_(std::move(options)),
      slots_("SRM"),
      listening_(scheduler, slots_,
                 {.started =
                      [this] {
                        if (!source_) return;
                        if (auto started = StartSource(); !started) {
                          slots_.ReportError("Input", started.error());
                        }
                      },
                  .stopped = [this] { StopListening(); },
                  .exit = [this] { exit_requested_ = true; },
                  .hearing = [this] { return ear_ && ear_->in_speech(); },
                  .end = [this] { ear_->Finish(); }}),
      keep_(slots_) {
  listening_.Declare(options_.module_version);
  DeclareListen();
  DeclareLanguages();
  DeclareAgent();
  DeclareGrammar();
  DeclareInput();
  DeclareResult();
  keep_.Declare();
}

RecognizerModule::~RecognizerModule() { Shutdown(); }

bool RecognizerModule::Busy() const {
  return (listening_.on() && source_ && source_->Ends()) || (ear_ && ear_->in_speech()) ||
         listening_.armed() || (options_.transcriber && options_.transcriber->Busy());
}

void RecognizerModule::Shutdown() {
  listening_.Disarm();
  if (over_timer_ != 0) scheduler_.Cancel(std::exchange(over_timer_, 0));
  source_.reset();
  voice_.reset();
  if (options_.transcriber) options_.transcriber->Abandon();
}

// --- engines

vm::Result<Ear*> RecognizerModule::NeedEar() {
  if (ear_) return ear_.get();
  auto decoder = options_.open_decoder();
  if (!decoder) return std::unexpected(decoder.error());
  (*decoder)->set_most(most_);
  for (const auto& [word, spoken] : pronunciations_) {
    static_cast<void>((*decoder)->Pronounce(word, spoken));  // was right when it was set
  }
  auto spotter = options_.open_spotter();
  ear_ = std::make_unique<Ear>(
      std::move(*decoder), spotter ? std::move(*spotter) : nullptr, endpoints_,
      Ear::Events{
          .began = [this] { OnBegan(); },
          .partial = [this](const std::string& text) { slots_.Report("Result.partial", text); },
          .ended = [this](const Ear::Heard& heard) { OnEnded(heard); },
          .spotted = [this](const std::string& phrase) { slots_.Report("Spot.heard", phrase); },
          .whole = [this](const std::string& text) { return IsWhole(text); }});
  return ear_.get();
}

vm::Result<void> RecognizerModule::UseGrammars() {
  auto ear = NeedEar();
  if (!ear) return std::unexpected(ear.error());
  std::vector<const ear::Grammar*> grammars;
  for (const std::string& name : grammars_.active()) grammars.push_back(&grammars_.at(name));
  auto used = (*ear)->Use(grammars);
  grammars_used_ = used.has_value();
  return used;
}

// --- grammars

vm::Result<std::string> RecognizerModule::LoadGrammar(const std::string& name,
                                                      const std::string& text) {
  auto put = grammars_.Put(name, ear::ParseGrammar(text));
  if (put && grammars_used_ && grammars_.IsActive(name)) {
    if (auto used = UseGrammars(); !used) return std::unexpected(used.error());
  }
  return put;
}

vm::Result<std::string> RecognizerModule::DropGrammar(const std::string& name) {
  const auto was_active = grammars_.Drop(name);
  if (!was_active) return std::unexpected(was_active.error());
  if (*was_active) {
    if (grammars_used_) static_cast<void>(UseGrammars());
    slots_.Report("Grammar", grammars_.ActiveNames());
  }
  return name;
}

vm::Result<std::string> RecognizerModule::ActivateGrammars(const vm::SetValue& value) {
  auto wanted = grammars_.Chosen(value);
  if (!wanted) return std::unexpected(wanted.error());
  auto before = grammars_.Activate(std::move(*wanted));
  if (source_ && listening_.on()) {
    if (auto used = UseGrammars(); !used) {
      grammars_.Activate(std::move(before));
      static_cast<void>(UseGrammars());
      return std::unexpected(used.error());
    }
  } else {
    grammars_used_ = false;
  }
  return grammars_.ActiveNames();
}

}  // namespace srm
