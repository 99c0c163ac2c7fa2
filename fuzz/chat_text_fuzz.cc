// What a model writes: tags, sentences; what a user says to the rules. No sentence has a bracket
// that the voice would take for markup, and all of them fit into a line.

#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <string>
#include <string_view>

#include "chat/rules/rules.h"
#include "chat/tables/tables.h"
#include "chat/text/sentence_cutter.h"
#include "chat/text/tag_reader.h"
#include "vm_protocol/core/utf8.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const chat::TagTable table = *chat::TagTable::Parse("tags.txt", chat::tables::Tags());
  static const auto abbreviations = chat::ParseAbbreviations(chat::tables::Abbreviations());
  static chat::Rules rules = *chat::Rules::Parse("rules_en.txt", chat::tables::RulesEnglish());
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  chat::TagReader reader(table);
  chat::SentenceCutter cutter(abbreviations);
  const auto check = [](const std::vector<chat::Sentence>& sentences) {
    for (const chat::Sentence& sentence : sentences) {
      if (sentence.text.size() > chat::SentenceCutter::kMaxSentenceBytes ||
          sentence.text.find_first_of("<>\n") != std::string::npos ||
          vm::FirstBadUtf8(sentence.text)) {
        std::abort();
      }
      for (const auto& placed : sentence.within) {
        if (placed.at > sentence.text.size()) std::abort();
      }
    }
  };
  const auto take = [&](std::vector<chat::TagReader::Item> items) {
    for (auto& item : items) {
      if (const auto* const words = std::get_if<std::string>(&item)) {
        cutter.Feed(*words);
      } else {
        cutter.Mark(std::move(std::get<chat::Cue>(item)));
      }
      cutter.WouldEnd();
    }
    check(cutter.Take());
  };
  for (std::size_t at = 0; at < size; at += 5) take(reader.Feed(text.substr(at, 5)));
  take(reader.Flush());
  check(cutter.Flush());
  rules.Answer(text, "Galatea", std::tm{});
  static_cast<void>(chat::TagTable::Parse("x", text));
  static_cast<void>(chat::Rules::Parse("x", text));
  return 0;
}
