#include "task_manager/interpreter/position.h"

#include "task_manager/fetch/uri.h"
#include "task_manager/interpreter/signals.h"

namespace vxml {

const vm::xml::Node& Position::Here() const {
  if (element) return *element;
  return dialog ? *dialog->node : *document->root;
}

std::string Position::BaseOf(const vm::xml::Node& node) const {
  for (const vm::xml::Node* at = &node; at && at->parent; at = at->parent) {
    if (const std::string* base = at->Find("xml:base")) {
      return fetch::Resolve(document->base, *base);
    }
  }
  return document->base;
}

const VxmlDocument& Position::OriginOf(const vm::xml::Node& node) const {
  const vm::xml::Node* top = &node;
  while (top->parent) top = top->parent;
  return root && top == root->root.get() ? *root : *document;
}

std::string Position::LanguageAt(const vm::xml::Node& node) const {
  const std::string language = node.Inherited("xml:lang");
  return language.empty() && root ? root->language : language;
}

void Position::RequireLocal(const vm::xml::Node& node) const {
  const std::string& uri = OriginOf(node).uri;
  if (fetch::IsLocal(uri)) return;
  ThrowEvent("error.noauthorization",
             uri + ":" + std::to_string(node.line) + ": <" + node.name + "> only runs from files");
}

void Position::ThrowSemantic(const vm::xml::Node& node, const std::string& what) const {
  ThrowEvent("error.semantic", OriginOf(node).uri + ":" + std::to_string(node.line) + ":" +
                                   std::to_string(node.column) + ": " + what);
}

}  // namespace vxml
