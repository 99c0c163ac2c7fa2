#pragma once

#include <functional>
#include <optional>
#include <string>

#include "task_manager/platform/input_script.h"
#include "task_manager/platform/platform.h"

namespace vxml {

/// Dialogues in text: prompts are reported instead of spoken, input comes from commands. Time is
/// virtual: words take kMsPerLetter, and waiting takes nothing but the number.
/// Thread: the session's.
class TextPlatform final : public Platform {
 public:
  static constexpr int kMsPerLetter = 60;      ///< of alphabetic text
  static constexpr int kMsPerCharacter = 150;  ///< of kana and kanji
  static constexpr int kMsPerAudio = 1000;

  /// `write` gets each transcript line without newline.
  TextPlatform(CommandSource commands, std::function<void(const std::string& line)> write);

  Input Collect(const std::vector<Prompt>& prompts, const Listen& listen) override;
  bool Play(const std::vector<Prompt>& prompts) override;
  RecordResult Record(const std::vector<Prompt>& prompts, const RecordRequest& request) override;
  TransferResult Transfer(const std::vector<Prompt>& prompts,
                          const TransferRequest& request) override;
  void Disconnect() override {}
  void Native(const std::string& line) override;
  void Fetching(const std::string& uri, bool begins) override;
  Millis Now() const override { return now_; }
  void Report(std::string_view type, const JsonLine& fields) override;

  /// Input comes from somebody at a terminal: prompts are shown before it is asked for.
  void SetInteractive() { interactive_ = true; }
  /// True once input was wanted and there was none.
  bool ran_out() const { return ran_out_; }

 private:
  std::optional<Command> Next();
  /// Plays until `until` after the start (or the end), reporting what was heard.
  void PlayUntil(const std::vector<Prompt>& prompts, Millis until);
  void Keep(Millis length, const RecordRequest& request, RecordResult& result);
  void ReportCommand(const std::string& text, Millis wait, bool parallel);
  /// The prompt that plays at that time; null after the end.
  static const Prompt* PromptAt(const std::vector<Prompt>& prompts, Millis time);
  Input TakeKeys(const Command& command, const Listen& listen);
  /// Whether an input at that time is heard; if not it is reported as ignored.
  bool Heard(const std::vector<Prompt>& prompts, const Command& command, const Listen& listen);

  CommandSource commands_;
  std::function<void(const std::string&)> write_;
  std::optional<Command> pushed_back_;
  Millis now_{0};
  std::string mark_;
  Millis mark_at_{0};
  bool interactive_ = false;
  bool ran_out_ = false;
};

/// How long a segment or a whole prompt takes to render.
Millis DurationOf(const Segment& segment);
Millis DurationOf(const Prompt& prompt);

}  // namespace vxml
