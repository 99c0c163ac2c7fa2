// Grammars in the XML form of the W3C's Speech Recognition Grammar Specification 1.0: grammar,
// rule, ruleref (local rules, NULL VOID GARBAGE), one-of, item (repeat, weight), token, tag,
// example.

#include <tinyxml2.h>

#include <cstdlib>
#include <cstring>
#include <utility>

#include "ear/grammar/expansion.h"
#include "ear/grammar/grammar.h"
#include "ear/grammar/grammar_limits.h"

namespace ear {
namespace {

using Kind = Node::Kind;
using tinyxml2::XMLElement;
using tinyxml2::XMLNode;

std::size_t LineOf(const XMLNode& node) { return static_cast<std::size_t>(node.GetLineNum()); }

std::unexpected<vm::Error> Wrong(const XMLNode& node, const std::string& what) {
  return ear::Wrong(LineOf(node), what);
}

/// The name without a namespace's prefix.
std::string_view LocalName(const XMLElement& element) {
  const std::string_view name = element.Name();
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::string TextIn(const XMLElement& element) {
  std::string text;
  for (const XMLNode* child = element.FirstChild(); child; child = child->NextSibling()) {
    if (child->ToText() != nullptr) text += child->Value();
  }
  return std::string(Trim(text));
}

void AddWords(std::string_view text, std::size_t line, Node& sequence) {
  for (std::string& word : WordsOf(text)) {
    sequence.parts.push_back({.kind = Kind::kWord, .text = std::move(word), .line = line});
  }
}

/// "2", "2-4", "2-".
bool ReadRepeat(const char* text, Node& repeat) {
  char* rest = nullptr;
  const long least = std::strtol(text, &rest, 10);
  if (rest == text || least < 0 || least > kMaxRepeat) return false;
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

vm::Result<Node> Contents(const XMLElement& element, int depth);

vm::Result<Node> RuleReference(const XMLElement& element) {
  Node node{.kind = Kind::kRule, .line = LineOf(element)};
  if (const char* special = element.Attribute("special")) {
    if (std::strcmp(special, "NULL") == 0)
      node.kind = Kind::kSequence;
    else if (std::strcmp(special, "VOID") == 0)
      node.kind = Kind::kVoid;
    else if (std::strcmp(special, "GARBAGE") == 0)
      node.kind = Kind::kAny;
    else
      return Wrong(element,
                   std::string("special='") + special + "', expected NULL, VOID or GARBAGE");
    return node;
  }
  const char* uri = element.Attribute("uri");
  if (uri == nullptr || *uri != '#' || uri[1] == '\0') {
    return Wrong(element,
                 std::string("ruleref to '") + (uri ? uri : "") +
                     "', expected uri=\"#RULE\" or special (other files are not read here)");
  }
  node.text = uri + 1;
  return node;
}

vm::Result<Node> Alternatives(const XMLElement& element, int depth) {
  Node choice{.kind = Kind::kChoice, .line = LineOf(element)};
  for (const XMLElement* item = element.FirstChildElement(); item;
       item = item->NextSiblingElement()) {
    if (LocalName(*item) != "item") return Wrong(*item, "one-of may hold item only");
    auto node = Contents(*item, depth);
    if (!node) return node;
    double weight = 1;
    if (const char* text = item->Attribute("weight")) {
      char* rest = nullptr;
      weight = std::strtod(text, &rest);
      if (rest == text || *rest != '\0' || !(weight > 0)) {
        return Wrong(*item, std::string("weight='") + text + "', expected a number above 0");
      }
    }
    choice.parts.push_back(std::move(*node));
    choice.weights.push_back(weight);
  }
  if (choice.parts.empty()) return Wrong(element, "one-of holds no item");
  return choice;
}

vm::Result<Node> Element(const XMLElement& element, int depth) {
  const std::string_view name = LocalName(element);
  if (name == "item") return Contents(element, depth);
  if (name == "one-of") return Alternatives(element, depth);
  if (name == "ruleref") return RuleReference(element);
  if (name == "tag")
    return Node{.kind = Kind::kTag, .text = TextIn(element), .line = LineOf(element)};
  if (name == "token") {
    Node sequence{.line = LineOf(element)};
    AddWords(TextIn(element), sequence.line, sequence);
    return sequence;
  }
  if (name == "example") return Node{};
  return Wrong(element, "unknown element '" + std::string(element.Name()) + "'");
}

/// What an item or a rule holds, one after the other; an item's repeat around it.
vm::Result<Node> Contents(const XMLElement& element, int depth) {
  Node sequence{.line = LineOf(element)};
  if (depth > kMaxNesting) return sequence;  // Grammar::Make refuses the rule by its name
  for (const XMLNode* child = element.FirstChild(); child; child = child->NextSibling()) {
    if (child->ToText() != nullptr) {
      AddWords(child->Value(), LineOf(*child), sequence);
    } else if (const XMLElement* inner = child->ToElement()) {
      auto node = Element(*inner, depth + 1);
      if (!node) return node;
      sequence.parts.push_back(std::move(*node));
    }
  }
  const char* repeat = element.Attribute("repeat");
  if (repeat == nullptr) return sequence;
  Node node{.kind = Kind::kRepeat, .line = sequence.line};
  if (!ReadRepeat(repeat, node)) {
    return Wrong(element, std::string("repeat='") + repeat + "', expected N, N-M or N-");
  }
  node.parts.push_back(std::move(sequence));
  return node;
}

}  // namespace

vm::Result<Grammar> ParseSrgs(std::string_view text) {
  // A document type may hold entities; we need none, and take none.
  if (const std::size_t at = text.find("<!ENTITY"); at != std::string_view::npos) {
    return vm::Fail(vm::Errc::kSyntax, "a grammar with ENTITY declarations is not read");
  }
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    return vm::Fail(vm::Errc::kSyntax,
                    "line " + std::to_string(document.ErrorLineNum()) + ": the XML is broken (" +
                        tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID()) + ")");
  }
  const XMLElement* root = document.RootElement();
  if (root == nullptr || LocalName(*root) != "grammar") {
    return ear::Wrong(1, "expected a <grammar> element");
  }
  Grammar::Rules rules;
  std::string first;
  for (const XMLElement* element = root->FirstChildElement(); element;
       element = element->NextSiblingElement()) {
    const std::string_view name = LocalName(*element);
    if (name == "meta" || name == "metadata" || name == "lexicon" || name == "tag") continue;
    const char* id = element->Attribute("id");
    if (name != "rule" || id == nullptr) {
      return Wrong(*element, "expected <rule id=...>, found <" + std::string(name) + ">");
    }
    auto node = Contents(*element, 0);
    if (!node) return std::unexpected(node.error());
    if (!rules.emplace(id, std::move(*node)).second) {
      return Wrong(*element, std::string("rule '") + id + "' is there twice");
    }
    if (first.empty()) first = id;
  }
  const char* wanted = root->Attribute("root");
  if (wanted == nullptr && first.empty()) return Wrong(*root, "the grammar holds no rule");
  return Grammar::Make(std::move(rules), wanted != nullptr ? wanted : first);
}

}  // namespace ear
