#pragma once

#include <map>
#include <string>
#include <vector>

#include "task_manager/interpreter/document_set.h"
#include "task_manager/interpreter/markup.h"
#include "task_manager/platform/platform.h"

namespace vxml {

/// Turns prompt markup into segments, words and SSML, evaluating what has to be evaluated. One for
/// each prompt; errors are thrown as events.
class PromptBuilder {
 public:
  PromptBuilder(Runtime& runtime, DocumentSet& documents, Prompt& prompt)
      : rt_(runtime), documents_(documents), prompt_(prompt) {}

  void Add(const vm::xml::Node& node);
  void Finish();

 private:
  void AddChildren(const vm::xml::Node& node);
  void Words(const std::string& text);
  /// A word ends at the edge of an element of SSML (1.1 section 3.1.8.2), but for scripts that are
  /// written without blanks.
  void PartWords(const std::string& next);
  void EndWords();
  void Command(const std::string& line, Millis wait, bool parallel);
  void Speech(const vm::xml::Node& node);
  void Audio(const vm::xml::Node& node);
  void Audio(const vm::xml::Node& node, const script::Value& value);
  void Audio(const vm::xml::Node& node, const std::string& source);
  bool Exists(const vm::xml::Node& node, const std::string& uri,
              std::shared_ptr<const std::string>& sound);
  void Enumerate(const vm::xml::Node& node);
  void Foreach(const vm::xml::Node& node);
  void Pause(const vm::xml::Node& node);
  void Mark(const vm::xml::Node& node);

  Feeling FeelingOf(const vm::xml::Node& emotion) const;
  void Emotion(const vm::xml::Node& node);
  void Media(const vm::xml::Node& node);
  void Behaviour(const vm::xml::Node& node);
  void Anchor(const std::string& name);
  void PlaceDeferred();

  /// A behaviour that starts at a point of the speech.
  struct Deferred {
    std::string start;
    std::string command;
    std::size_t at;  ///< the segment it stands before
    std::size_t line;
  };

  Runtime& rt_;
  DocumentSet& documents_;
  Prompt& prompt_;
  std::string words_;
  std::string ssml_;
  bool at_edge_ = false;  ///< of an element, since the last words
  std::string speech_;    ///< id of the element around the words, "" = none
  std::vector<Feeling> feelings_;
  std::map<std::string, std::size_t> anchors_;  ///< point -> the segment behind it
  std::vector<Deferred> deferred_;
};

}  // namespace vxml
