// Grammars in the XML form of the W3C's Speech Recognition Grammar Specification 1.0: grammar,
// rule, ruleref (local rules, NULL VOID GARBAGE), one-of, item (repeat, weight), token, tag,
// example. Elements of other namespaces say nothing.

#include <cstdlib>
#include <utility>

#include "ear/grammar/expansion.h"
#include "ear/grammar/grammar.h"
#include "ear/grammar/grammar_limits.h"
#include "vm_protocol/xml/parser.h"

namespace ear {
namespace {

using Kind = Node::Kind;
using Element = vm::xml::Node;

std::unexpected<vm::Error> Wrong(const Element& element, const std::string& what) {
  return ear::Wrong(element.line, what);
}

/// An element of SRGS, or of no namespace as shortcuts write it.
bool IsOurs(const Element& element) {
  return element.IsElement() &&
         (element.space.empty() || element.space == "http://www.w3.org/2001/06/grammar");
}

void AddWords(std::string_view text, std::size_t line, Node& sequence) {
  for (std::string& word : WordsOf(text)) {
    sequence.parts.push_back({.kind = Kind::kWord, .text = std::move(word), .line = line});
  }
}

/// "2", "2-4", "2-".
bool ReadRepeat(const std::string& text, Node& repeat) {
  char* rest = nullptr;
  const long least = std::strtol(text.c_str(), &rest, 10);
  if (rest == text.c_str() || least < 0 || least > kMaxRepeat) return false;
  repeat.least = repeat.most = static_cast<int>(least);
  if (*rest == '\0') return true;
  if (*rest++ != '-') return false;
  repeat.most = kUnlimited;
  if (*rest == '\0') return true;
  char* end = nullptr;
  const long most = std::strtol(rest, &end, 10);
  if (end == rest || *end != '\0' || most < least || most > kMaxRepeat) return false;
  repeat.most = static_cast<int>(most);
  return true;
}

vm::Result<Node> Contents(const Element& element, int depth);

vm::Result<Node> RuleReference(const Element& element) {
  Node node{.kind = Kind::kRule, .line = element.line};
  if (const std::string* special = element.Find("special")) {
    if (*special == "NULL") return Node{.line = element.line};
    if (*special == "VOID") return Node{.kind = Kind::kVoid, .line = element.line};
    if (*special == "GARBAGE") return GarbageNode(element.line);
    return Wrong(element, "special='" + *special + "', expected NULL, VOID or GARBAGE");
  }
  const std::string uri = element.Get("uri");
  if (!uri.starts_with('#') || uri.size() < 2) {
    return Wrong(element, "ruleref to '" + uri +
                              "', expected uri=\"#RULE\" or special (other files are not read "
                              "here)");
  }
  node.text = uri.substr(1);
  return node;
}

vm::Result<Node> Alternatives(const Element& element, int depth) {
  Node choice{.kind = Kind::kChoice, .line = element.line};
  for (const auto& item : element.children) {
    if (!IsOurs(*item)) continue;
    if (item->name != "item") return Wrong(*item, "one-of may hold item only");
    auto node = Contents(*item, depth);
    if (!node) return node;
    double weight = 1;
    if (const std::string* text = item->Find("weight")) {
      char* rest = nullptr;
      weight = std::strtod(text->c_str(), &rest);
      if (rest == text->c_str() || *rest != '\0' || !(weight > 0)) {
        return Wrong(*item, "weight='" + *text + "', expected a number above 0");
      }
    }
    choice.parts.push_back(std::move(*node));
    choice.weights.push_back(weight);
  }
  if (choice.parts.empty()) return Wrong(element, "one-of holds no item");
  return choice;
}

vm::Result<Node> Part(const Element& element, int depth) {
  const std::string& name = element.name;
  if (name == "item") return Contents(element, depth);
  if (name == "one-of") return Alternatives(element, depth);
  if (name == "ruleref") return RuleReference(element);
  if (name == "tag") {
    return Node{
        .kind = Kind::kTag, .text = std::string(Trim(element.Text())), .line = element.line};
  }
  if (name == "token") {
    Node sequence{.line = element.line};
    AddWords(element.Text(), sequence.line, sequence);
    return sequence;
  }
  if (name == "example") return Node{};
  return Wrong(element, "unknown element '" + name + "'");
}

/// What an item or a rule holds, one after the other; an item's repeat around it.
vm::Result<Node> Contents(const Element& element, int depth) {
  Node sequence{.line = element.line};
  if (depth > kMaxNesting) return sequence;  // Grammar::Make refuses the rule by its name
  for (const auto& child : element.children) {
    if (child->IsText()) {
      AddWords(child->text, child->line, sequence);
    } else if (IsOurs(*child)) {
      auto node = Part(*child, depth + 1);
      if (!node) return node;
      sequence.parts.push_back(std::move(*node));
    }
  }
  const std::string* repeat = element.Find("repeat");
  if (repeat == nullptr) return sequence;
  Node node{.kind = Kind::kRepeat, .line = sequence.line};
  if (!ReadRepeat(*repeat, node)) {
    return Wrong(element, "repeat='" + *repeat + "', expected N, N-M or N-");
  }
  node.parts.push_back(std::move(sequence));
  return node;
}

}  // namespace

vm::Result<Grammar> ParseSrgs(std::string_view text) {
  const auto document = vm::xml::Parse(text, "grammar");
  if (!document) return std::unexpected(document.error());
  const Element& root = *document->root;
  if (!IsOurs(root) || root.name != "grammar") {
    return ear::Wrong(root.line, "expected a <grammar> element");
  }
  Grammar::Rules rules;
  std::string first;
  for (const auto& child : root.children) {
    const std::string& name = child->name;
    if (!IsOurs(*child) || name == "meta" || name == "metadata" || name == "lexicon" ||
        name == "tag") {
      continue;
    }
    const std::string* id = child->Find("id");
    if (name != "rule" || id == nullptr) {
      return Wrong(*child, "expected <rule id=...>, found <" + name + ">");
    }
    auto node = Contents(*child, 0);
    if (!node) return std::unexpected(node.error());
    if (!rules.emplace(*id, std::move(*node)).second) {
      return Wrong(*child, "rule '" + *id + "' is there twice");
    }
    if (first.empty()) first = *id;
  }
  if (!root.Has("root") && first.empty()) return Wrong(root, "the grammar holds no rule");
  return Grammar::Make(std::move(rules), root.Get("root", first));
}

}  // namespace ear
