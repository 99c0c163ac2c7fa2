#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/message.h"

namespace am {

/// A text with variables in it, parsed once and expanded often: ${name}, ${name:-default}, and
/// ${name|plain}, which writes a phoneme list in the form of LipSync.pho. Pure.
/// Limits: the expanded text has at most vm::kMaxLineBytes.
class Template {
 public:
  /// Returns a variable's value; empty if there is no variable of that name.
  using Lookup = std::function<std::string(const std::string& name)>;
  Template() = default;
  /// Errors: kBadValue for an unknown filter, a missing name or a brace that is not closed.
  static vm::Result<Template> Parse(std::string_view text);
  /// Errors: kTooLong; for ${name|plain} those of vm::ParsePhonemes.
  vm::Result<std::string> Expand(const Lookup& lookup) const;

 private:
  struct Part {
    std::string literal;  ///< stands before the variable
    std::string name;     ///< empty: no variable follows
    std::string fallback;
    bool plain_phonemes = false;
  };
  std::vector<Part> parts_;
};

/// A message whose value is a template. Receiver, command and slot are fixed.
class MessageTemplate {
 public:
  MessageTemplate() = default;
  /// Errors: as ParseMessage and Template::Parse; kSyntax for a line without a receiver.
  static vm::Result<MessageTemplate> Parse(std::string_view line);
  /// Errors: as Template::Expand; kBadValue if the expanded message is not valid.
  vm::Result<vm::Message> Expand(const Template::Lookup& lookup) const;
  /// The message with an empty value.
  const vm::Message& message() const { return message_; }

 private:
  vm::Message message_;
  Template value_;
};

}  // namespace am
