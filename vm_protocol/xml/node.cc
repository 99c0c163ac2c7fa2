#include "vm_protocol/xml/node.h"

#include "vm_protocol/core/blanks.h"
#include "vm_protocol/core/xml_text.h"

namespace vm::xml {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

void Collect(const Node& node, std::string& into) {
  if (node.IsText()) into += node.text;
  for (const auto& child : node.children) Collect(*child, into);
}

void WriteTo(const Node& node, std::string& out) {
  if (node.IsText()) {
    out += Escape(node.text);
    return;
  }
  if (!node.IsElement()) return;
  const std::string name = node.prefix.empty() ? node.name : node.prefix + ":" + node.name;
  out += "<" + name;
  for (const Attribute& attribute : node.attributes) {
    out += " " + attribute.name + "=\"" + Escape(attribute.value) + "\"";
  }
  if (node.children.empty()) {
    out += "/>";
    return;
  }
  out += ">";
  for (const auto& child : node.children) WriteTo(*child, out);
  out += "</" + name + ">";
}

}  // namespace

const std::string* Node::Find(std::string_view wanted) const {
  for (const Attribute& attribute : attributes) {
    if (attribute.name == wanted) return &attribute.value;
  }
  return nullptr;
}

std::string Node::Get(std::string_view wanted, std::string_view otherwise) const {
  const std::string* value = Find(wanted);
  return value ? *value : std::string(otherwise);
}

std::string Node::Inherited(std::string_view wanted) const {
  for (const Node* node = this; node; node = node->parent) {
    if (const std::string* value = node->Find(wanted)) return *value;
  }
  return "";
}

std::string Node::Text() const {
  std::string text_below;
  Collect(*this, text_below);
  return text_below;
}

const Node* Node::FirstElement(std::string_view wanted) const {
  for (const auto& child : children) {
    if (child->IsElement(wanted)) return child.get();
  }
  return nullptr;
}

Node& Node::Add(std::unique_ptr<Node> child) {
  child->parent = this;
  children.push_back(std::move(child));
  return *children.back();
}

std::string Collapse(std::string_view text) {
  std::string result;
  bool gap = false;
  for (const char c : text) {
    if (kBlanks.find(c) != std::string_view::npos) {
      gap = !result.empty();
      continue;
    }
    if (gap) result += ' ';
    gap = false;
    result += c;
  }
  return result;
}

std::string_view Trim(std::string_view text) { return vm::Trimmed(text, kBlanks); }

bool IsBlank(std::string_view text) {
  return text.find_first_not_of(kBlanks) == std::string_view::npos;
}

std::string Escape(std::string_view text) { return vm::EscapeXml(text); }

std::string Write(const Node& node) {
  std::string out;
  WriteTo(node, out);
  return out;
}

std::unique_ptr<Node> Clone(const Node& node) {
  auto copy = std::make_unique<Node>();
  copy->kind = node.kind;
  copy->name = node.name;
  copy->prefix = node.prefix;
  copy->space = node.space;
  copy->text = node.text;
  copy->cdata = node.cdata;
  copy->line = node.line;
  copy->column = node.column;
  copy->attributes = node.attributes;
  for (const auto& child : node.children) copy->Add(Clone(*child));
  return copy;
}

}  // namespace vm::xml
