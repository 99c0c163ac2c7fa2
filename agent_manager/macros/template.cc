#include "agent_manager/macros/template.h"

#include <algorithm>
#include <utility>

#include "vm_protocol/core/limits.h"
#include "vm_protocol/core/phonemes.h"
#include "vm_protocol/core/utf8.h"

namespace am {

using vm::Errc;
using vm::Fail;
using vm::Message;
using vm::Result;

Result<Template> Template::Parse(std::string_view text) {
  Template parsed;
  while (!text.empty()) {
    const std::size_t open = text.find("${");
    Part part;
    part.literal = text.substr(0, open);
    if (open != std::string_view::npos) {
      const std::size_t close = text.find('}', open);
      if (close == std::string_view::npos)
        return Fail(Errc::kBadValue, "'${' without '}' in '" + std::string(text) + "'");
      const std::string_view inside = text.substr(open + 2, close - open - 2);
      const std::size_t fallback = inside.find(":-");
      const std::size_t filter = std::min(inside.find('|'), fallback);
      part.name = inside.substr(0, filter);
      if (fallback != std::string_view::npos) part.fallback = inside.substr(fallback + 2);
      if (filter < fallback) {
        if (inside.substr(filter + 1) != "plain")
          return Fail(Errc::kBadValue,
                      "unknown filter in '${" + std::string(inside) + "}', expected plain");
        part.plain_phonemes = true;
      }
      if (part.name.empty())
        return Fail(Errc::kBadValue,
                    "found '${" + std::string(inside) + "}', expected a name in it");
      text.remove_prefix(close + 1);
    } else {
      text = {};
    }
    parsed.parts_.push_back(std::move(part));
  }
  return parsed;
}

Result<std::string> Template::Expand(const Lookup& lookup) const {
  std::string out;
  for (const Part& part : parts_) {
    out += part.literal;
    if (!part.name.empty()) {
      std::string value = lookup(part.name);
      if (value.empty()) value = part.fallback;
      if (part.plain_phonemes) {
        const auto phonemes = vm::ParsePhonemes(value);
        if (!phonemes) return std::unexpected(phonemes.error());
        value = vm::FormatPhonemesPlain(*phonemes);
      }
      out += value;
    }
    if (out.size() > vm::kMaxLineBytes)
      return Fail(Errc::kTooLong,
                  "the text becomes longer than " + std::to_string(vm::kMaxLineBytes) + " bytes");
  }
  return out;
}

Result<MessageTemplate> MessageTemplate::Parse(std::string_view line) {
  auto message = vm::ParseMessage(line);
  if (!message) return std::unexpected(message.error());
  if (message->to.empty())
    return Fail(Errc::kSyntax,
                "found '" + std::string(line) + "', expected a line with a receiver, to @NAME ...");
  auto value = Template::Parse(message->value);
  if (!value) return std::unexpected(value.error());
  MessageTemplate parsed;
  parsed.message_ = std::move(*message);
  parsed.message_.from.clear();
  parsed.message_.value.clear();
  parsed.value_ = std::move(*value);
  return parsed;
}

Result<Message> MessageTemplate::Expand(const Template::Lookup& lookup) const {
  auto value = value_.Expand(lookup);
  if (!value) return std::unexpected(value.error());
  Message message = message_;
  value->erase(0, std::min(value->find_first_not_of(" \t"), value->size()));
  message.value = std::move(*value);
  if (!vm::IsValid(message))
    return Fail(Errc::kBadValue, "no message comes of '" + message_.slot + "' with the value '" +
                                     std::string(vm::CutUtf8(message.value, 60)) + "'");
  return message;
}

}  // namespace am
