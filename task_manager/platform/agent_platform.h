#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "task_manager/platform/hub_link.h"
#include "task_manager/platform/input_script.h"
#include "task_manager/platform/platform.h"
#include "task_manager/platform/sound_keeper.h"

namespace vxml {

/// Dialogues with voice, ear and face through the hub: prompts by @AM-MCL's Speak, input from
/// @SRM, expressions to @FSM. What stands between the words starts where the voice passes its
/// BOOKMARK. Input is what the ear hears; typed lines (keyboard) and scripts are put into it.
/// While listening the agent looks at the user and nods to what it hears; on long fetches it looks
/// aside (property attention). Sound files are played by the voice. There is no recording and no
/// telephone: error.unsupported.record, .transfer. Time is the hub's where a script drives the
/// dialogue (films), else the machine's. Thread: the session's.
class AgentPlatform final : public Platform {
 public:
  struct Options {
    CommandSource script{};  ///< empty: ear or keyboard
    std::string voice = "SSM";
    std::string ear = "SRM";
    std::string face = "FSM";
    std::string name = "DM";  ///< of this dialogue at the hub: its grammar in the ear is named so
    std::function<void(const std::string& line)> write{};
  };
  AgentPlatform(HubLink& hub, Options options);

  Input Collect(const std::vector<Prompt>& prompts, const Listen& listen) override;
  bool Play(const std::vector<Prompt>& prompts) override;
  RecordResult Record(const std::vector<Prompt>& prompts, const RecordRequest& request) override;
  TransferResult Transfer(const std::vector<Prompt>& prompts,
                          const TransferRequest& request) override;
  void Disconnect() override {}
  void Native(const std::string& line) override;
  void Fetching(const std::string& uri, bool begins) override;
  Millis Now() const override;
  void Report(std::string_view type, const JsonLine& fields) override;
  bool ran_out() const { return ran_out_; }
  /// Lets so much of the hub's time pass.
  void Pause(Millis time);

 private:
  void Say(const Prompt& prompt, bool may_be_stopped);
  bool Utter(const std::string& text, bool may_be_stopped);
  void PlaySound(const Segment& segment, bool may_be_stopped);
  void PlayFile(const std::string& file, bool may_be_stopped);
  std::string Tagged(const std::vector<Segment>& segments);
  void Act(std::size_t index);
  void StartParallel(const Prompt& prompt);
  void OnTyped(const std::string& line);
  void UseGrammars(const Listen& listen);
  void Interrupt(const Command& command, const std::vector<Prompt>& prompts, const Listen& listen);
  std::optional<Command> Next();
  void Hear(Input::Kind kind, std::vector<Hypothesis> hypotheses);
  std::optional<Input> FromScript(const std::optional<Command>& command, const Listen& listen);
  std::optional<Input> Taken();
  bool Speaks(const std::vector<Prompt>& prompts, bool listening);

  HubLink& hub_;
  Options options_;
  std::vector<std::string> actions_;  ///< of the prompt being spoken, by bookmark; "mark NAME"
  std::size_t acted_ = 0;
  std::deque<std::string> sounds_;  ///< files @SND was told to play
  bool has_sound_module_ = false;
  SoundKeeper fetched_sounds_;
  std::string in_ear_;           ///< phrases of the grammar loaded last, "" = none
  bool interrupting_ = false;    ///< a scripted interruption is on its way
  std::optional<Command> next_;  ///< of the script, taken but not used
  bool attends_ = true;
  std::string beside_;  ///< steps of PAR for the next speech
  std::deque<Input> heard_;
  bool hearing_ = false;  ///< somebody speaks
  bool ran_out_ = false;
  std::string mark_;
  std::chrono::steady_clock::time_point mark_at_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_nod_ = start_;
};

}  // namespace vxml
