#include "task_manager/grammar/xml_rules.h"

#include <algorithm>

#include "task_manager/grammar/text.h"

namespace vxml::srgs {

using vm::xml::Node;
using Kind = Expansion::Kind;

std::unexpected<vm::Error> XmlRules::Bad(const Node& at, const std::string& what,
                                         vm::Errc code) const {
  return vm::Fail(code, context_.uri + ":" + std::to_string(at.line) + ":" +
                            std::to_string(at.column) + ": " + what);
}

bool XmlRules::IsForeign(const Node& node) const {
  return !node.space.empty() && node.space != kSrgsSpace && node.space != space_;
}
vm::Result<void> XmlRules::CheckContent(const Node& node, bool text) const {
  for (const auto& child : node.children) {
    if (child->IsElement() && !IsForeign(*child)) {
      return Bad(*child, "<" + child->name + "> in <" + node.name + ">");
    }
    if (!text && child->IsText() && !vm::xml::IsBlank(child->text)) {
      return Bad(*child, "text in <" + node.name + ">");
    }
  }
  return {};
}

XmlRules::Made XmlRules::Sequence(const Node& node, std::size_t depth) const {
  auto sequence = std::make_unique<Expansion>();
  sequence->kind = Kind::kSequence;
  for (const auto& child : node.children) {
    if (child->IsText()) {
      if (!AddTokens(child->text, *sequence)) return Bad(*child, "a quotation mark without end");
      if (sequence->children.size() > kMaxExpansions) return Bad(*child, "too many words");
      continue;
    }
    if (!child->IsElement() || IsForeign(*child)) continue;
    if (child->name == "example" && node.name == "rule") {
      if (auto done = CheckContent(*child, true); !done) return std::unexpected(done.error());
      continue;
    }
    auto part = Expand(*child, depth + 1);
    if (!part) return part;
    if (*part) sequence->children.push_back(std::move(*part));
  }
  return sequence;
}

bool XmlRules::AddTokens(std::string_view text, Expansion& into) const {
  while (!vm::xml::IsBlank(text)) {
    text.remove_prefix(text.find_first_not_of(" \t\r\n"));
    std::size_t end = 0;
    if (text[0] == '"') {
      end = text.find('"', 1);
      if (end == std::string_view::npos) return false;
      into.children.push_back(MakeToken(text.substr(1, end - 1)));
      text.remove_prefix(end + 1);
      continue;
    }
    end = std::min(text.find_first_of(" \t\r\n\""), text.size());
    into.children.push_back(MakeToken(text.substr(0, end)));
    text.remove_prefix(end);
  }
  return true;
}

XmlRules::Made XmlRules::Expand(const Node& node, std::size_t depth) const {
  if (depth > kMaxGrammarDepth) {
    return Bad(node, "nested deeper than " + std::to_string(kMaxGrammarDepth), vm::Errc::kLimit);
  }
  const std::string& name = node.name;
  if (name == "token") return Token(node);
  if (name == "ruleref") return Reference(node);
  if (name == "item") return Item(node, depth);
  if (name == "one-of") return OneOf(node, depth);
  if (name == "tag") {
    if (auto done = CheckContent(node, true); !done) return std::unexpected(done.error());
    auto tag = std::make_unique<Expansion>();
    tag->kind = Kind::kTag;
    tag->text = node.Text();
    tag->line = node.line;
    return tag;
  }
  return Bad(node, "<" + name + "> is not part of a grammar here");
}

XmlRules::Made XmlRules::Token(const Node& node) const {
  if (auto done = CheckContent(node, true); !done) return std::unexpected(done.error());
  std::string text = node.Text();
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && text[first] == '"') std::erase(text, '"');
  auto token = MakeToken(text);
  token->language = node.Get("xml:lang");
  if (node.Has("xml:lang") && !IsLanguage(token->language)) {
    return Bad(node, "xml:lang '" + token->language + "' is no language");
  }
  token->phoneme = node.Get("phoneme");
  token->sym = node.Get("sym");
  if (token->text.empty()) token->text = token->sym;
  if (token->text.empty()) return Bad(node, "<token> without content");
  if (token->folded.empty()) token->folded = Fold(token->text);
  return token;
}

XmlRules::Made XmlRules::Reference(const Node& node) const {
  auto reference = std::make_unique<Expansion>();
  reference->line = node.line;
  reference->column = node.column;
  if (auto done = CheckContent(node, false); !done) return std::unexpected(done.error());
  const std::string* uri = node.Find("uri");
  const std::string* special = node.Find("special");
  if ((uri == nullptr) == (special == nullptr)) {
    return Bad(node, "<ruleref> needs either uri or special");
  }
  if (special) {
    if (!IsSpecialRule(*special)) {
      return Bad(node, "special '" + *special + "', expected NULL, VOID or GARBAGE");
    }
    reference->kind = *special == "NULL"   ? Kind::kNull
                      : *special == "VOID" ? Kind::kVoid
                                           : Kind::kGarbage;
    return reference;
  }
  if (uri->empty() || *uri == "#") return Bad(node, "<ruleref> with an empty uri");
  reference->kind = Kind::kReference;
  reference->type = node.Get("type");
  SplitReference(*uri, *reference);
  return reference;
}

XmlRules::Made XmlRules::Item(const Node& node, std::size_t depth) const {
  auto inner = Sequence(node, depth);
  if (!inner) return inner;
  const std::string* repeat = node.Find("repeat");
  if (const std::string* weight = node.Find("weight")) {
    double value = 0;
    if (!ParseWeight(*weight, value) || value <= 0) {
      return Bad(node, "weight '" + *weight + "', expected a number above 0");
    }
  }
  if (const std::string* probability = node.Find("repeat-prob")) {
    double value = 0;
    if (!ParseWeight(*probability, value) || value > 1) {
      return Bad(node, "repeat-prob '" + *probability + "', expected 0.0 to 1.0");
    }
  }
  if (!repeat) return inner;
  auto outer = MakeRepeat(std::move(*inner));
  if (!ParseRepeat(vm::xml::Trim(*repeat), *outer)) {
    return Bad(node, "repeat '" + *repeat + "', expected N, N-M or N- up to " +
                         std::to_string(kMaxRepeat));
  }
  return outer;
}

XmlRules::Made XmlRules::OneOf(const Node& node, std::size_t depth) const {
  auto choice = std::make_unique<Expansion>();
  choice->kind = Kind::kAlternatives;
  for (const auto& child : node.children) {
    if (child->IsText() && !vm::xml::IsBlank(child->text)) {
      return Bad(*child, "text in <one-of>, expected <item>");
    }
    if (!child->IsElement() || IsForeign(*child)) continue;
    if (child->name != "item") {
      return Bad(*child, "<" + child->name + "> in <one-of>, expected <item>");
    }
    auto item = Item(*child, depth + 1);
    if (!item) return item;
    choice->children.push_back(std::move(*item));
    double weight = 1;
    if (const std::string* given = child->Find("weight")) ParseWeight(*given, weight);
    choice->weights.push_back(weight);
  }
  if (choice->children.empty()) return Bad(node, "<one-of> without <item>");
  return choice;
}

}  // namespace vxml::srgs
