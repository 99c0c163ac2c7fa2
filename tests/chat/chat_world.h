#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "chat/core/chat_module.h"
#include "chat/tables/tables.h"
#include "tests/chat/fake_transport.h"

namespace chat_test {

/// The module on a virtual clock, with the network and the hub played by the test. The voice takes
/// kPrepare before a sentence sounds and kByte for each of its bytes.
class ChatWorld {
 public:
  using Millis = std::chrono::milliseconds;
  static constexpr Millis kPrepare{60};
  static constexpr Millis kByte{50};

  explicit ChatWorld(chat::Endpoint endpoint = {}, bool hub = true) : hub_(hub) {
    chat::ChatModule::Options options{
        .module_version = "test",
        .endpoint = std::move(endpoint),
        .model = "stub",
        .prompt = "You are $agent.",
        .talk = "For this: $goal",
        .tags = *chat::TagTable::Parse("tags.txt", chat::tables::Tags()),
        .abbreviations = chat::ParseAbbreviations(chat::tables::Abbreviations()),
        .apologies = *chat::Apologies::Parse("apologies.txt", chat::tables::Apologies()),
        .wall_clock = [] { return std::tm{}; }};
    options.rules.push_back(*chat::Rules::Parse("rules_en.txt", chat::tables::RulesEnglish()));
    options.rules.push_back(*chat::Rules::Parse("rules_ja.txt", chat::tables::RulesJapanese()));
    module = std::make_unique<chat::ChatModule>(clock, net, std::move(options));
    module->slots().set_output([this](vm::PeerId, const vm::Message& message) {
      lines.push_back(Now() + " " + vm::FormatMessage(message));
      if (hub_ && !message.to.empty()) clock.Post([this, message] { OnHub(message); });
    });
    module->slots().set_on_error([this](vm::PeerId, const std::string&, const vm::Error& error) {
      errors.push_back(vm::FormatError(error));
    });
    clock.RunReady();
  }

  void Tell(const std::string& line) {
    module->slots().HandleLine(line, 1);
    clock.RunReady();
  }
  /// What the ear reports.
  void Ear(const std::string& report) { Tell("From @SRM rep " + report); }
  void Until(long ms) { clock.RunUntil(Millis(ms)); }
  void UntilIdle() { clock.RunUntilIdle(clock.Now() + std::chrono::hours(1)); }
  std::string Now() const { return vm::FormatMs(clock.Now()); }
  /// Lines that have `part`, with their times.
  std::vector<std::string> Lines(const std::string& part) const {
    std::vector<std::string> found;
    for (const std::string& line : lines) {
      if (line.contains(part)) found.push_back(line);
    }
    return found;
  }
  std::string Value(const std::string& slot) const { return module->slots().Value(slot); }
  std::string History() const {
    const_cast<ChatWorld*>(this)->Tell("inq#h History");
    return lines.back().substr(lines.back().find('['));
  }

  vm::VirtualScheduler clock;
  FakeTransport net;
  std::unique_ptr<chat::ChatModule> module;
  std::vector<std::string> lines, errors;
  bool voice_is_there = true;
  std::string refused_slots;             ///< answers to tools
  std::string modules = "SSM SRM CHAT";  ///< at the hub

 private:
  void Answer(const vm::Message& asked, const std::string& value) {
    if (asked.tag.empty()) return;
    module->slots().HandleLine("From @" + asked.to[0] + " rep#" + asked.tag + " " + asked.slot +
                               " = " + value);
  }
  void Refuse(const vm::Message& asked, const std::string& error) {
    if (asked.tag.empty()) return;
    module->slots().HandleLine("From @" + asked.to[0] + " rep#" + asked.tag + " " + asked.slot +
                               ".error = " + error);
  }
  void Voice(const std::string& line) { module->slots().HandleLine("From @SSM rep " + line); }

  void OnHub(const vm::Message& message) {
    if (message.slot == "Speak" && message.to[0] == "AM-MCL") return OnSpeak(message);
    if (message.slot == "Speak.spoken") return Answer(message, spoken_words_);
    if (message.slot == "Slots") return Answer(message, "Run Listen Listen.complete");
    if (message.slot == "Modules") return Answer(message, modules);
    if (message.slot == "Life") return Answer(message, "LIVELY");
    if (message.to[0] == "LAMP") return Refuse(message, "BAD_VALUE no such light");
    if (message.command == vm::Command::kSet) Answer(message, message.value);
    if (message.command == vm::Command::kInq) Refuse(message, "UNKNOWN_SLOT");
  }
  void OnSpeak(const vm::Message& message) {
    if (message.value == "STOP") {
      if (speaking_) End(true);
      return Answer(message, "STOP");
    }
    if (!voice_is_there) return Refuse(message, "UNAVAILABLE the voice @SSM is not there");
    speaking_ = message;
    begins_ = clock.After(kPrepare, [this] {
      began_ = clock.Now();
      const long marks = static_cast<long>(speaking_->value.find("<BOOKMARK MARK=\""));
      Voice("Speak.stat = SPEAKING");
      if (marks >= 0) {
        const std::string name = speaking_->value.substr(static_cast<std::size_t>(marks) + 16);
        clock.After(kByte * marks, [this, mark = name.substr(0, name.find('"'))] {
          Voice("Speak.mark = " + mark + " 1");
        });
      }
    });
    ends_ = clock.After(kPrepare + kByte * static_cast<long>(message.value.size()),
                        [this] { End(false); });
  }
  void End(bool stopped) {
    const vm::Message said = *std::exchange(speaking_, std::nullopt);
    clock.Cancel(begins_);
    clock.Cancel(ends_);
    const auto bytes = static_cast<std::size_t>((clock.Now() - began_) / kByte);
    // Words that have begun count.
    spoken_words_ = said.value.substr(0, bytes);
    if (stopped) {
      const auto space = spoken_words_.rfind(' ');
      if (space != std::string::npos) spoken_words_.erase(space);
    }
    Voice("Speak.stat = IDLE");
    stopped ? Refuse(said, "STOPPED stopped on request after 1 ms") : Answer(said, said.value);
  }

  const bool hub_;
  std::optional<vm::Message> speaking_;
  vm::Time began_{0};
  vm::TimerId begins_ = 0, ends_ = 0;
  std::string spoken_words_;
};

inline chat::Endpoint Stub(std::vector<std::string> allow_set = {}) {
  return {
      .url = "http://stub/v1/chat/completions", .key = "sk-1", .allow_set = std::move(allow_set)};
}

}  // namespace chat_test
