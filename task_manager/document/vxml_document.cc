#include "task_manager/document/vxml_document.h"

#include <algorithm>

#include "task_manager/document/schema.h"
#include "task_manager/fetch/uri.h"
#include "task_manager/xml/parser.h"

namespace vxml {
namespace {

constexpr std::string_view kSpace = "http://www.w3.org/2001/vxml";

bool NamesBadFetch(const xml::Node& handler) {
  if (handler.IsElement("error")) return true;
  if (!handler.IsElement("catch")) return false;
  const std::string events = handler.Get("event");
  const auto words = SplitWords(events);
  return std::any_of(words.begin(), words.end(), [](std::string_view event) {
    return event == "error" || event == "error.badfetch";
  });
}

bool HasHandler(const xml::Node& parent) {
  return std::any_of(parent.children.begin(), parent.children.end(),
                     [](const auto& child) { return NamesBadFetch(*child); });
}

/// True if the element would find a handler for error.badfetch in its own document. What stands
/// outside of dialogs (links, handlers) acts in each of them.
bool HandlesBadFetch(const xml::Node& node, const VxmlDocument& document) {
  const xml::Node* dialog = nullptr;
  for (const xml::Node* at = node.parent; at; at = at->parent) {
    if (HasHandler(*at)) return true;
    if (at->IsElement("form") || at->IsElement("menu")) dialog = at;
  }
  return !dialog && std::any_of(document.dialogs.begin(), document.dialogs.end(),
                                [](const xml::Node* each) { return HasHandler(*each); });
}

void CollectProperties(const xml::Node& node, VxmlDocument& into) {
  for (const auto& child : node.children) {
    if (!child->IsElement()) continue;
    if (child->name == "property" && child->Has("value")) {
      into.properties[&node][child->Get("name")] = child->Get("value");
    }
    CollectProperties(*child, into);
  }
}

}  // namespace

bool IsVoiceXml(const xml::Node& node) {
  return node.space.empty() || node.space == kSpace ||
         node.space.find("/vxml") != std::string::npos;
}

const std::string* VxmlDocument::FindProperty(const xml::Node& element,
                                              const std::string& name) const {
  const auto of_element = properties.find(&element);
  if (of_element == properties.end()) return nullptr;
  const auto found = of_element->second.find(name);
  return found == of_element->second.end() ? nullptr : &found->second;
}

const xml::Node* VxmlDocument::FindDialog(const std::string& id) const {
  for (const xml::Node* dialog : dialogs) {
    if (dialog->Get("id") == id) return dialog;
  }
  return nullptr;
}

vm::Result<std::shared_ptr<VxmlDocument>> LoadDocument(std::string_view bytes,
                                                       const std::string& uri,
                                                       const std::string& charset) {
  auto parsed = xml::Parse(bytes, uri, charset);
  if (!parsed) return std::unexpected(parsed.error());
  auto document = std::make_shared<VxmlDocument>();
  document->uri = fetch::WithoutFragment(uri);
  document->root = std::move(parsed->root);
  const xml::Node& root = *document->root;
  const std::string base = root.Get("xml:base");
  document->base = base.empty() ? document->uri : fetch::Resolve(document->uri, base);
  document->language = root.Get("xml:lang");
  document->version = root.Get("version");
  if (const std::string* application = root.Find("application");
      application && !application->empty()) {
    document->application = fetch::WithoutFragment(fetch::Resolve(document->base, *application));
  }
  for (const auto& child : root.children) {
    if (child->IsElement("form") || child->IsElement("menu"))
      document->dialogs.push_back(child.get());
  }
  CollectProperties(root, *document);
  for (const Finding& finding : CheckDocument(*document)) {
    if (finding.severity != Finding::Severity::kError) continue;
    if (!finding.thrown_at || !HandlesBadFetch(*finding.thrown_at, *document)) {
      return vm::Fail(vm::Errc::kSyntax, FormatFinding(uri, finding));
    }
    document->thrown_at.emplace(finding.thrown_at, FormatFinding(uri, finding));
  }
  return document;
}

}  // namespace vxml
