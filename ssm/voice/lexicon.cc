#include "ssm/voice/lexicon.h"

#include <algorithm>

#include "ssm/voice/pronounced_text.h"
#include "vm_protocol/core/utf8.h"
#include "vm_protocol/xml/parser.h"

namespace ssm {
namespace {

using vm::xml::Node;

std::unexpected<vm::Error> Bad(const std::string& name, const Node& at, const std::string& what) {
  return vm::Fail(vm::Errc::kSyntax, name + ":" + std::to_string(at.line) + ":" +
                                         std::to_string(at.column) + ": " + what);
}

const Node* Preferred(const Node& lexeme) {
  const Node* first = nullptr;
  for (const auto& child : lexeme.children) {
    if (!child->IsElement("phoneme") && !child->IsElement("alias")) continue;
    if (child->Get("prefer") == "true") return child.get();
    if (first == nullptr) first = child.get();
  }
  return first;
}

vm::Result<std::string> IpaOf(const std::string& text, const std::string& alphabet) {
  if (alphabet == "x-sampa") return IpaOfSampa(text);
  if (alphabet == "x-arpabet" || alphabet == "x-cmu") return IpaOfArpabet(text);
  return text;
}

bool IsSpacedLetter(std::string_view text, std::size_t at) {
  const char32_t c = vm::SignAt(text, at).value;
  return (c >= U'a' && c <= U'z') || (c >= U'A' && c <= U'Z') || (c >= U'0' && c <= U'9') ||
         (c >= 0xC0 && c < 0x2000);
}

/// The sign before `at` begins here.
std::size_t Before(std::string_view text, std::size_t at) {
  do --at;
  while (at > 0 && !vm::BeginsSign(text[at]));
  return at;
}

}  // namespace

vm::Result<Lexicon> Lexicon::Parse(std::string_view xml, const std::string& name) {
  const auto document = vm::xml::Parse(xml, name);
  if (!document) return std::unexpected(document.error());
  const Node& root = *document->root;
  if (!root.IsElement("lexicon")) {
    return Bad(name, root, "found <" + root.name + ">, expected <lexicon>");
  }
  Lexicon lexicon;
  for (const auto& lexeme : root.children) {
    if (!lexeme->IsElement("lexeme")) continue;
    const Node* how = Preferred(*lexeme);
    if (how == nullptr) return Bad(name, *lexeme, "<lexeme> without <phoneme> or <alias>");
    Entry entry;
    if (how->name == "alias") {
      entry.alias = vm::xml::Collapse(how->Text());
    } else {
      const std::string alphabet = how->Get("alphabet", root.Get("alphabet", "ipa"));
      auto ipa = IpaOf(vm::xml::Collapse(how->Text()), alphabet);
      if (!ipa) return Bad(name, *how, ipa.error().text);
      entry.ipa = std::move(*ipa);
    }
    for (const auto& child : lexeme->children) {
      if (!child->IsElement("grapheme")) continue;
      entry.grapheme = vm::xml::Collapse(child->Text());
      if (entry.grapheme.empty()) continue;
      if (entry.grapheme.size() > kMaxGrapheme ||
          entry.alias.size() + entry.ipa.size() > kMaxSaid) {
        return vm::Fail(vm::Errc::kLimit, name + ":" + std::to_string(lexeme->line) +
                                              ": a word over " + std::to_string(kMaxGrapheme) +
                                              " bytes, or one said in over " +
                                              std::to_string(kMaxSaid));
      }
      if (lexicon.entries_.size() >= kMaxEntries) {
        return vm::Fail(vm::Errc::kLimit,
                        name + ": more than " + std::to_string(kMaxEntries) + " words");
      }
      lexicon.longest_ = std::max(lexicon.longest_, entry.grapheme.size());
      lexicon.entries_.emplace(entry.grapheme, entry);
    }
  }
  return lexicon;
}

const Lexicon::Entry* Lexicon::Find(std::string_view text, std::size_t at) const {
  if (at > 0 && IsSpacedLetter(text, Before(text, at)) && IsSpacedLetter(text, at)) return nullptr;
  for (std::size_t size = std::min(longest_, text.size() - at); size > 0; --size) {
    const std::string_view word = text.substr(at, size);
    const bool cut = at + size < text.size() && IsSpacedLetter(text, at + size) &&
                     IsSpacedLetter(text, Before(text, at + size));
    if (cut) continue;
    if (const auto found = entries_.find(word); found != entries_.end()) return &found->second;
  }
  return nullptr;
}

}  // namespace ssm
