#pragma once

#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "chat/core/history.h"
#include "chat/core/hub_line.h"
#include "chat/core/speaker.h"
#include "chat/core/thinker.h"
#include "chat/rules/rules.h"
#include "chat/text/apologies.h"
#include "chat/text/end_phrases.h"
#include "chat/text/sentence_cutter.h"
#include "chat/text/tag_reader.h"
#include "vm_protocol/core/module.h"

namespace chat {

/// The module that talks (CHAT): what the ear hears, or Input.text says, goes to a language model
/// or to rules; what comes back is spoken sentence by sentence while the rest still comes.
///
///   IDLE --words--> THINKING --first sentence--> SPEAKING --all said--> IDLE
///                        somebody begins to speak, Say = STOP --> IDLE, once the voice is silent
///
/// A reply that is stopped counts as far as it was heard. Thread: the scheduler's.
class ChatModule final : public vm::Module {
 public:
  struct Options {
    std::string module_version{};
    Endpoint endpoint{};
    std::string model{};
    std::string prompt{};  ///< of the system; $agent is the agent's name
    std::string persona{};
    std::string talk{};  ///< told to the model of a conversation that is lent; $goal is its goal
    std::string agent = "Galatea";
    bool listens = true;
    TagTable tags{};
    Abbreviations abbreviations{};
    Apologies apologies{};
    std::vector<Rules> rules{};
    std::string ear = "SRM", voice = "SSM", face = "FSM";
    std::function<std::tm()> wall_clock{};
  };

  /// Clock and transport outlive it.
  ChatModule(vm::Scheduler& clock, vm::HttpTransport& transport, Options options);
  ~ChatModule() override;

  vm::SlotMachine& slots() override { return slots_; }
  bool Busy() const override { return turn_ || !waiting_.empty(); }
  bool ExitRequested() const override { return exit_requested_; }
  void Shutdown() override;

  static constexpr std::size_t kMaxInput = 8 << 10;

 private:
  /// What is to be answered, or to be said as it is.
  struct Input {
    std::string text;
    bool as_it_is = false;
    vm::Reply reply;
  };
  struct Turn {
    Input input;
    vm::Time began{0};
    std::optional<vm::Time> words{}, sentence{}, sound{};
    std::optional<vm::Error> error{};
    bool stopped = false;
    bool unspoken = false;  ///< a sentence could not be spoken, and that was said
  };
  struct Talk {
    vm::Reply reply;
    int turns = 0, most = 0;
    vm::Time silence{0};
    std::string last{};
    std::string borrower{};  ///< its name at the hub; empty: not known
    std::string goal{};
    EndPhrases end_phrases{};
    std::string ending{};  ///< the reason, once it is known
  };

  // chat_slots.cc
  void DeclareInput();
  void DeclareModel();
  void DeclareHistory();
  void DeclareReports();
  void DeclareTalk();
  void Told(std::string name, std::string help, std::string initial = "");

  // Meeting the hub.
  void MeetHub();
  std::string Subscriptions() const;
  void OnHubAnswer(const vm::Result<std::string>& answer);
  void PrepareVoice();
  void StartEar();
  void AskForHaste(bool haste);
  void OnHeard(const vm::Message& message);
  void OnEar(const vm::Message& message);

  // A turn.
  void Take(Input input);
  void Begin(Input input);
  void Think();
  void OnWords(const std::string& words);
  void Speak(std::vector<Sentence> sentences, bool counts = true);
  void OnThought(const std::optional<ModelFailure>& failure);
  void Apologise(Trouble trouble);
  void Interrupt();
  void EndTurn();
  void TakeWaiting();
  void ReportTimes();
  void SetBusy(const std::string& state);
  void Perform(const Cue& cue);
  bool Listens() const { return slots_.Value("Listen") == "ON" || talk_; }
  bool UsesModel() const { return !options_.endpoint.url.empty(); }
  std::string LanguageOf(const std::string& text) const;
  Thinker::Settings ThinkerSettings() const;
  int Number(const char* slot) const { return std::stoi(slots_.Value(slot)); }

  // A conversation lent to a dialogue.
  void StartTalk(const vm::SetValue& value, const vm::Reply& reply);
  void WatchBorrower();
  void OnBorrowerGone();
  Talk TakeBack();
  void FailTalk(const vm::Error& error);
  void EndTalk(std::string reason);
  void WaitForTalk();

  vm::Scheduler& clock_;
  Options options_;
  vm::SlotMachine slots_;
  HubLine hub_;
  Speaker speaker_;
  Thinker thinker_;
  History history_;
  enum class HubState { kUnknown, kThere, kAlone } hub_state_ = HubState::kUnknown;
  std::string life_;  ///< of the face at the start; empty or OFF: it is left alone

  std::optional<Turn> turn_;
  std::vector<Input> waiting_;  ///< for the hub, or for the end of the turn
  std::optional<TagReader> reader_;
  std::optional<SentenceCutter> cutter_;
  vm::TimerId cut_timer_ = 0, hub_timer_ = 0;
  std::optional<vm::Time> last_nod_;
  std::optional<Talk> talk_;
  vm::TimerId talk_timer_ = 0;
  bool exit_requested_ = false;
};

}  // namespace chat
