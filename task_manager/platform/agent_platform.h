#pragma once

#include <deque>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "task_manager/platform/hub_link.h"
#include "task_manager/platform/input_script.h"
#include "task_manager/platform/lent_conversation.h"
#include "task_manager/platform/platform.h"
#include "task_manager/platform/sound_keeper.h"

namespace vxml {

/// Dialogues with voice, ear and face through the hub: prompts by @AM-MCL's Speak, input from
/// @SRM, expressions to @FSM. What stands between the words starts where the voice passes its
/// BOOKMARK. Input is what the ear hears; typed lines (keyboard) and scripts are put into it.
/// While listening the agent looks at the user and nods to what it hears; on long fetches it looks
/// aside (property attention). Sound files are played by the voice. The ear keeps what is recorded,
/// in a folder of the session's, so both have to see the same disk. There is no telephone:
/// error.unsupported.transfer. Time is the hub's where a script drives the dialogue (films) and the
/// hub lets it be watched, else the machine's. Thread: the session's.
class AgentPlatform final : public Platform {
 public:
  struct Options {
    CommandSource script{};  ///< empty: ear or keyboard
    std::string voice = "SSM";
    std::string ear = "SRM";
    std::string face = "FSM";
    std::string chat = "CHAT";
    std::string name = "DM";  ///< of this dialogue at the hub: its grammar in the ear is named so
    std::function<void(const std::string& line)> write{};
  };
  AgentPlatform(HubLink& hub, Options options);
  ~AgentPlatform() override;

  Input Collect(const std::vector<Prompt>& prompts, const Listen& listen) override;
  bool Play(const std::vector<Prompt>& prompts) override;
  RecordResult Record(const std::vector<Prompt>& prompts, const RecordRequest& request) override;
  TransferResult Transfer(const std::vector<Prompt>& prompts,
                          const TransferRequest& request) override;
  TalkResult Talk(const std::vector<Prompt>& prompts, const TalkRequest& request) override;
  vm::Result<std::string> Recording(const std::string& uri) const override;
  void Disconnect() override {}
  void Native(const std::string& line) override;
  void Fetching(const std::string& uri, bool begins) override;
  Millis Now() const override;
  void Report(std::string_view type, const JsonLine& fields) override;
  /// From now on times are counted from this instant.
  void StartTime();
  bool ran_out() const { return ran_out_; }
  /// Lets so much of the hub's time pass.
  void Pause(Millis time);

 private:
  void Say(const Prompt& prompt, bool may_be_stopped);
  void ReportAt(Millis time, std::string_view type, const JsonLine& fields);
  void ReportSaid(const Prompt& prompt, bool cut);
  bool Utter(const std::string& text, bool may_be_stopped);
  void PlaySound(const Segment& segment, bool may_be_stopped);
  void PlayFile(const std::string& file, bool may_be_stopped);
  /// Steps of macros (docs/protocol.md). SpeakingStep waits until the voice speaks.
  static nlohmann::json PauseStep(Millis time);
  static nlohmann::json SendStep(const std::string& line);
  nlohmann::json SpeakingStep() const;
  /// The name of this dialogue's own macro for the purpose; other dialogues have theirs.
  std::string Macro(const std::string& purpose);
  std::string Tagged(const std::vector<Segment>& segments);
  void Act(std::size_t index);
  void StartParallel(const Prompt& prompt);
  bool OnTyped(const std::string& line);
  /// Nothing more is typed, and nothing typed is on its way.
  bool TypedOver() const { return hub_.typed_end() && typed_waiting_ == 0; }
  void UseGrammars(const Listen& listen);
  void Interrupt(const Command& command, const std::vector<Prompt>& prompts, const Listen& listen);
  std::optional<Command> Next();
  void Hear(Input::Kind kind, std::vector<Hypothesis> hypotheses);
  std::optional<Input> FromScript(const std::optional<Command>& command, const Listen& listen);
  std::optional<Input> Taken();
  void Attend();
  void SetLife(const std::string& life);
  bool Speaks(const std::vector<Prompt>& prompts, bool listening);
  // agent_talk.cc
  bool HungUp() const;
  void HandOverHeard();
  void AwaitTalk(Millis left);
  void TalkFromScript();
  void ReportTalk(bool user, const std::string& text);
  void ReportSentence();
  // agent_recording.cc
  bool KeepSounds(bool keep);
  void OnSound(const std::string& told);
  void AddSound(Input& input);
  std::string EarSetting(const std::string& slot, const std::string& value);
  void RecordScripted(const std::optional<Command>& command, const RecordRequest& request);
  void AwaitRecording(const RecordRequest& request);
  bool Ends(const Input& key, const RecordRequest& request) const;
  void PressKey(const Input& key, const RecordRequest& request, RecordResult& result) const;
  void EndUtterance();
  bool TakeSound(RecordResult& result);
  RecordResult Recorded(const RecordRequest& request);
  void Beep();

  HubLink& hub_;
  Options options_;
  /// What happens at a bookmark of the prompt being spoken.
  struct Action {
    bool is_mark = false;
    std::string text;  ///< the mark's name, or the line
    Millis delay{0};   ///< so much later than the bookmark, by the hub's clock
  };
  std::vector<Action> actions_;
  std::size_t acted_ = 0;
  std::deque<std::string> sounds_;  ///< files @SND was told to play
  bool has_sound_module_ = false;
  SoundKeeper sounds_kept_;
  /// What the ear kept of an utterance, until its result comes.
  struct KeptSound {
    Millis length{0};
    std::size_t bytes = 0;
    bool cut = false;  ///< it was too long
    std::string uri;
  };
  static constexpr Millis kMacroLimit{20'000};        ///< of one step of a macro
  static constexpr std::size_t kMaxRecordings = 256;  ///< as many files as the ear keeps
  bool keeps_ = false;                                ///< the ear keeps sounds now
  std::optional<KeptSound> sound_;
  std::map<std::string, std::string> recordings_;  ///< URI: file
  std::deque<std::string> recording_order_;        ///< their URIs, oldest first
  std::size_t recording_count_ = 0;
  std::string in_ear_;           ///< phrases of the grammar loaded last, "" = none
  bool interrupting_ = false;    ///< a scripted interruption is on its way
  std::optional<Command> next_;  ///< of the script, taken but not used
  bool attends_ = true;
  std::string life_, life_now_;  ///< the face's slot Life: at the start, and now
  nlohmann::json beside_ = nlohmann::json::array();  ///< steps of PAR for the next speech
  std::set<std::string> macros_;                     ///< defined at the hub, removed at the end
  std::deque<Input> heard_;
  std::size_t typed_waiting_ = 0;  ///< typed lines the ear has not answered
  bool hearing_ = false;           ///< somebody speaks
  bool ran_out_ = false;
  std::optional<LentConversation> talk_;  ///< while the user is lent
  Millis talk_silence_{0};
  std::optional<std::string> sentence_;  ///< of @CHAT, not reported yet
  std::string mark_;
  Millis mark_at_{0};
  /// With a script a prompt is reported when it was said, before what came meanwhile (held_).
  std::optional<Millis> spoken_from_;
  Millis spoken_to_{0};
  bool saying_ = false;
  std::vector<std::string> held_;
  Millis zero_{0};  ///< where times are counted from
  std::chrono::steady_clock::time_point last_nod_{};
};

}  // namespace vxml
