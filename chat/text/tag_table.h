#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vm_protocol/core/message.h"

namespace chat {

/// A tag as it stood in a text: `<emotion name="HAPPY" strength="60"/>`, `[emotion HAPPY 60]`.
struct Tag {
  std::string name;  ///< lower case; that of a closing tag begins with '/'
  /// Values with their names in lower case; a name is empty where the value stood alone.
  std::vector<std::pair<std::string, std::string>> values;

  bool operator==(const Tag&) const = default;
};

/// What is said to the hub for a tag.
using Cue = std::vector<vm::Message>;

/// What tags mean, and what the face does while the agent waits, hears, thinks and speaks: the
/// table tables/tags.txt, whose head explains its form. Constant once it is read.
class TagTable {
 public:
  /// Errors: kSyntax or kBadValue with FILE:LINE.
  static vm::Result<TagTable> Parse(const std::string& file, std::string_view text);

  bool Knows(std::string_view tag) const { return tags_.contains(tag); }
  /// The text within the element of that name is not for the listener (<think>).
  bool IsSilent(std::string_view tag) const;
  /// The commands of a tag. None for a tag the table does not have, and where a value that the
  /// commands need is missing or none of those allowed. Numbers beyond their limits are taken to
  /// them.
  std::optional<Cue> CueOf(const Tag& tag) const;
  /// The commands of a state (WAITS HEARS THINKS SPEAKS); `life` takes the place of $life.
  Cue AtState(std::string_view state, const std::string& life) const;

 private:
  struct Parameter {
    std::string name;
    std::vector<std::string> words;  ///< those allowed, upper case; empty: a number, or any word
    bool any_word = false;
    double low = 0, high = 0;
    std::string usual;  ///< empty: it must be given
  };
  struct Row {
    std::vector<Parameter> parameters;
    Cue commands;
  };
  using Values = std::map<std::string, std::string>;
  static vm::Result<Parameter> ParseParameter(std::string_view text);
  static vm::Result<Cue> ParseCommands(std::string_view text);
  static std::optional<std::string> Fitting(const Parameter& parameter, const std::string& value);
  static Cue Filled(const Cue& commands, const Values& values);
  vm::Result<void> AddRow(std::string_view head, std::string_view commands);

  std::map<std::string, Row, std::less<>> tags_;
  std::map<std::string, Cue, std::less<>> states_;
  std::vector<std::string> silent_;
};

}  // namespace chat
